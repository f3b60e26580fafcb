//! Abaqus: cards as Abaqus and others write them; parts and instances.

use stribeck_mesh::decks::Deck;

use crate::{INP, INP_SETS, NODES, check};

#[test]
fn issue_abaqus_cards_as_their_programs_write_them() {
    let with = |from: &str, to: &str| {
        assert!(INP.contains(from));
        format!("{}{INP_SETS}", INP.replacen(from, to, 1))
    };
    let lines = "*ELEMENT, TYPE=T3D2, ELSET=Line1\n11, 1, 2\n12, 2, 3\n*ELEMENT, TYPE=T3D2, ELSET=Line2\n13, \
        4, 5\n14, 5, 6\n";
    for (name, text) in [
        ("sets of one line", format!("{INP}{INP_SETS}")),
        ("small letters and blanks", format!("{INP}{INP_SETS}").to_lowercase().replace(", ", " , ")),
        ("a keyword that goes on below", with("CPE4, ELSET", "CPE4,\n** a comment\n ELSET")),
        ("a keyword with one comma too many", with("ELSET=steel", "ELSET=steel,")),
        (
            "a set at nodes",
            format!(
                "{}{}",
                INP.replacen("*NODE", "*NODE, NSET=raceway", 1).replacen(
                    "4, 0., 1.",
                    "*NODE, NSET=fit\n4, 0., 1.",
                    1
                ),
                ""
            ),
        ),
        (
            "sets of sets",
            format!(
                "{INP}*NSET, NSET=all\nr1, FIT\n*NSET, NSET=r1\n1, 2\n*NSET, NSET=raceway\nR1, 3\n*NSET, \
                 NSET=fit\n4\n5\n6,\n"
            ),
        ),
        (
            "a set of twenty items a line",
            format!(
                "{INP}*NSET, NSET=raceway\n1,2,3,1,2,3,1,2,3,1,2,3,1,2,3,1,2,1,2,3\n*NSET, \
                 NSET=fit\n4,4,4,4,4,4,4,4,4,4,4,4,4,4,4,4,4,4,5,6\n"
            ),
        ),
        (
            "ranges",
            format!(
                "{INP}*NSET, NSET=raceway, GENERATE\n1, 3\n*NSET, NSET=fit, GENERATE\n4, 6, 2\n5, 5, 1\n"
            ),
        ),
        (
            "nodes of elements along lines",
            format!("{INP}{lines}*NSET, NSET=raceway, ELSET=Line1\n*NSET, NSET=fit, ELSET=Line2\n"),
        ),
        (
            "sets of elements along lines",
            format!("{INP}{lines}*ELSET, ELSET=raceway\n11, 12,\n*ELSET, ELSET=fit\nLine2\n"),
        ),
        (
            "an element on two lines, other types",
            format!("{INP}{INP_SETS}").replace("1, 1, 2, 5, 4", "1, 1, 2,\n5, 4").replace("CPE4", "S4R"),
        ),
        (
            "masses and beams",
            format!(
                "{INP}*ELEMENT, TYPE=MASS, ELSET=m\n21, 1\n*ELEMENT, TYPE=B31H\n22, 1, 2\n*ELEMENT, \
                 TYPE=SPRINGA\n23, 1, 2\n{INP_SETS}"
            ),
        ),
        (
            "names in quotes",
            format!("{INP}{INP_SETS}").replace("=raceway", "=\"raceway\"").replace("=steel", "=\"steel\""),
        ),
        ("lines of Windows", format!("{INP}{INP_SETS}").replace('\n', "\r\n")),
        ("a byte order mark", format!("\u{feff}{INP}{INP_SETS}")),
    ] {
        check(name, Deck::Abaqus, text.as_bytes(), "steel");
    }
    let latin: Vec<u8> =
        [b"*HEADING\nAu\xdfenring\n".as_slice(), INP.as_bytes(), INP_SETS.as_bytes()].concat();
    check("Latin-1", Deck::Abaqus, &latin, "steel");
    let read = check(
        "lines",
        Deck::Abaqus,
        format!("{INP}{lines}*SURFACE, NAME=s\n*SURFACE, NAME=t\n{INP_SETS}").as_bytes(),
        "steel",
    );
    assert_eq!(
        read.notes,
        [
            "line 11 and 1 more: elements of type `T3D2` are passed over, as they lie along lines",
            "line 17 and 1 more: `*SURFACE` is not read"
        ]
    );
}

/// As Abaqus/CAE writes it: a part, an instance that is shifted and turned, sets of the part and of the
/// assembly.
#[test]
fn issue_abaqus_parts_and_instances() {
    let part = format!(
        "*Heading\n*Preprint, echo=NO\n*Part, name=Ring\n{INP}*Nset, nset=inner\n 1, 2, 3\n*End Part\n"
    );
    let sets = "*Nset, nset=raceway, instance=Ring-1\n 1, 2\n 3,\n*Nset, nset=fit, instance=Ring-1, \
        generate\n 4, 6, 1\n";
    let one = format!(
        "{part}*Assembly, name=Assembly\n*Instance, name=Ring-1, part=Ring\n*End Instance\n{sets}*End \
         Assembly\n*Material, name=m\n"
    );
    let read = check("one instance", Deck::Abaqus, one.as_bytes(), "steel");
    assert_eq!(read.notes, ["line 26: `*MATERIAL` is not read"]);
    assert_eq!(read.node_sets["inner"].len(), 3);
    // The part lies one below and turned by -90° about the origin.
    let lain = part
        .replace("1, 0., 0., 0.", "1, 0., -1.")
        .replace("2, 1., 0.", "2, 0., -2.")
        .replace("3, 2., 0.", "3, 0., -3.")
        .replace("4, 0., 1.", "4, 1., -1.")
        .replace("5, 1., 1.", "5, 1., -2.")
        .replace("6, 2., 1.", "6, 1., -3.");
    let text = format!(
        "{lain}*Assembly, name=A\n*Instance, name=Ring-1, part=Ring\n0., 1., 0.\n0., 0., 0., 0., 0., 1., \
         90.\n*End Instance\n{sets}*End Assembly\n"
    );
    let read = Deck::Abaqus.read(&text).expect("a mesh");
    for (place, expected) in
        read.mesh.x.iter().zip(&read.mesh.y).zip([0, 1, 4, 3, 2, 5].map(|n: usize| NODES[n]))
    {
        assert!(
            (place.0 - expected[0]).abs() < 1e-15 && (place.1 - expected[1]).abs() < 1e-15,
            "{place:?} {expected:?}"
        );
    }
    // Two instances have the same node numbers, and do not share nodes.
    let two = format!(
        "{part}*Assembly, name=A\n*Instance, name=A, part=Ring\n*End Instance\n*Instance, name=B, \
         part=Ring\n0., 5., 0.\n*End Instance\n\
         *Nset, nset=raceway, instance=B\n1, 2, 3\n*Nset, nset=both\nA.inner, B.1\n*End Assembly\n"
    );
    let read = Deck::Abaqus.read(&two).expect("a mesh");
    assert_eq!((read.mesh.x.len(), read.mesh.quads.len()), (12, 4));
    let ys = |set: &str| read.node_sets[set].iter().map(|&n| read.mesh.y[n as usize]).collect::<Vec<_>>();
    assert_eq!((ys("raceway"), ys("both")), (vec![5.0; 3], vec![0.0, 0.0, 0.0, 5.0]));
    assert_eq!((ys("A.inner"), ys("B.inner")), (vec![0.0; 3], vec![5.0; 3]));
    let bodies: Vec<&str> = read.mesh.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(bodies, ["A.steel", "B.steel"]);
    for (text, says) in [
        (
            two.replace("\n1, 2, 3\n*Nset, nset=both\nA.inner", "\n1, 2, 3\n*Nset, nset=both\n1"),
            "of any instance",
        ),
        (two.replace("A.inner", "C.inner"), "no set of nodes `C.inner`"),
        (two.replace("instance=B\n1", "instance=C\n1"), "no instance `C`"),
    ] {
        let notes = Deck::Abaqus.read(&text).expect("a mesh").notes;
        assert!(notes.iter().any(|note| note.contains(says)), "{notes:?}");
    }
    for (text, says) in [
        (two.replace("part=Ring\n0.", "part=Rung\n0."), "no part `RUNG`"),
        (two.replace("0., 5., 0.", "0., 5., 0.\n0., 0., 0., 1., 0., 0., 90."), "not along z"),
    ] {
        let why = Deck::Abaqus.read(&text).expect_err(says).to_string();
        assert!(why.contains(says), "{why}");
    }
}
