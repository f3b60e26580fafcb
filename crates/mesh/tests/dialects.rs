//! Files of meshes as other programs write them: each dialect says the same small mesh, and is read as the
//! same.
//!
//! ```text
//!  4 ─── 5 ─── 6      y = 1
//!  │  1  │  2  │
//!  1 ─── 2 ─── 3      y = 0
//! x=0   1     2
//! ```
//!
//! Two squares, `steel`; nodes 1, 2, 3 are the set `raceway`, nodes 4, 5, 6 the set `fit`.

use std::process::Command;

use stribeck_mesh::decks::{Deck, ReadDeck, included};
use stribeck_testing::{Scratch, peer::python_with, said};

const NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]];

/// The nodes and elements of an Abaqus file.
const INP: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 0., 1.\n5, 1., 1.\n6, 2., 1.\n\
                   *ELEMENT, TYPE=CPE4, ELSET=steel\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n";
const INP_SETS: &str = "*NSET, NSET=raceway\n1, 2, 3\n*NSET, NSET=fit\n4, 5, 6\n";

/// Holds a mesh against the drawing above; elements may be in any body where `body` is empty.
fn check(name: &str, deck: Deck, bytes: &[u8], body: &str) -> ReadDeck {
    let read = deck.read_bytes(bytes).unwrap_or_else(|why| panic!("{name}: {why}"));
    let place = |n: u32| [read.mesh.x[n as usize], read.mesh.y[n as usize]];
    let quads: Vec<[[f64; 2]; 4]> = read.mesh.quads.iter().map(|quad| quad.map(place)).collect();
    let expected = [[0, 1, 4, 3], [1, 2, 5, 4]].map(|quad| quad.map(|n: usize| NODES[n]));
    assert_eq!(quads, expected, "{name}");
    assert_eq!((read.mesh.x.len(), read.mesh.triangles.len()), (6, 0), "{name}");
    for (set, expected) in [("raceway", &NODES[..3]), ("fit", &NODES[3..])] {
        let nodes =
            read.node_sets.get(set).unwrap_or_else(|| panic!("{name}: no {set} in {:?}", read.node_sets));
        let mut places: Vec<[f64; 2]> = nodes.iter().map(|&n| place(n)).collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(places, expected, "{name}: {set}");
    }
    let bodies: Vec<&str> = read.mesh.bodies.iter().map(|body| body.name.as_str()).collect();
    assert!(body.is_empty() || bodies == [body], "{name}: {bodies:?}");
    read
}

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
    // Two instances have the same numbers, and none of the other's nodes.
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

/// A set with members that are not there is passed over and named. meshio writes one such into every file
/// that it has from Gmsh.
#[test]
fn issue_sets_that_name_what_is_not_there() {
    let text = format!(
        "{INP}{INP_SETS}*ELSET, ELSET=gmsh:bounding_entities\n3, -2\n*NSET, NSET=a\nb\n*NSET, NSET=b\na\n"
    );
    let read = check("meshio", Deck::Abaqus, text.as_bytes(), "steel");
    assert_eq!(read.notes.len(), 3, "{:?}", read.notes);
    assert!(
        read.notes[2].contains("`gmsh:bounding_entities` is passed over: there is no set of elements `-2`"),
        "{:?}",
        read.notes
    );
    assert!(
        read.notes[0].contains("the set `a` is passed over: sets lie within each other more than"),
        "{:?}",
        read.notes
    );
    let text = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT_SHELL\n1,1,1,2,3,3\n*SET_NODE_ADD\n1\n2\n*SET_NODE_ADD\n2\n1\n*SET_NODE_ADD\n3\n9\n";
    let read = Deck::LsDyna.read(text).expect("a mesh");
    assert!(read.node_sets.is_empty() && read.notes.len() == 3, "{:?}", read.notes);
    assert!(read.notes[2].contains("there is no set of nodes 9"), "{:?}", read.notes);
}

/// Nodes and elements of an LS-DYNA file in columns of these widths.
fn k(keyword: &str, node: &str, shell: &str, widths: [usize; 3]) -> String {
    let [n, c, e] = widths;
    let mut text = format!(
        "{keyword}\n$ comment\n*PART\nsteel\n{:>2$}{:>2$}\n*NODE{node}\n",
        7,
        1,
        if keyword.contains("LONG") { 20 } else { 10 }
    );
    for (at, [x, y]) in NODES.iter().enumerate() {
        text += &format!("{:>n$}{x:>c$}{y:>c$}{:>c$}\n", at + 1, 0.0);
    }
    text += &format!("*ELEMENT_SHELL{shell}\n");
    for (at, quad) in [[1, 2, 5, 4], [2, 3, 6, 5]].iter().enumerate() {
        text += &format!("{:>e$}{:>e$}", at + 1, 7);
        quad.iter().for_each(|corner| text += &format!("{corner:>e$}"));
        text += "\n";
        if shell.contains("THICKNESS") {
            text += &format!("{0:>16.4}{0:>16.4}{0:>16.4}{0:>16.4}\n", 15.0);
        }
        if shell.contains("OFFSET") {
            text += &format!("{:>16.4}\n", 0.5);
        }
    }
    text
}

fn k_sets(width: usize) -> String {
    let mut text = String::new();
    for (number, title, nodes) in [(1, "raceway", [1, 2, 3]), (2, "fit", [4, 5, 6])] {
        text += &format!("*SET_NODE_LIST_TITLE\n{title}\n{number:>width$}\n");
        nodes.iter().for_each(|node| text += &format!("{node:>width$}"));
        text += "\n";
    }
    text + "*END\n"
}

#[test]
fn issue_lsdyna_cards_as_their_programs_write_them() {
    let standard = || k("*KEYWORD", "", "", [8, 16, 8]);
    let sets = |cards: &str| standard() + cards + "*END\n";
    for (name, text) in [
        ("standard", standard() + &k_sets(10)),
        ("thicknesses", k("*KEYWORD", "", "_THICKNESS", [8, 16, 8]) + &k_sets(10)),
        ("thicknesses and offsets", k("*KEYWORD", "", "_THICKNESS_OFFSET", [8, 16, 8]) + &k_sets(10)),
        ("LONG=Y", k("*KEYWORD LONG=Y", "", "", [20, 20, 20]) + &k_sets(20)),
        ("I10=Y", k("*KEYWORD I10=Y", "", "", [10, 16, 10]) + &k_sets(10)),
        ("I10=Y behind others", k("*KEYWORD MEMORY=200M I10=Y", "", "", [10, 16, 10]) + &k_sets(10)),
        ("a plus", k("*KEYWORD", " +", " +", [20, 20, 20]) + &k_sets(10)),
        ("a per cent sign", k("*KEYWORD", " %", "%", [10, 16, 10]) + &k_sets(10)),
        ("a minus", k("*KEYWORD LONG=Y", " -", " -", [8, 16, 8]) + &k_sets(20)),
        ("commas", "*KEYWORD\n*NODE\n1,0,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n*PART\nsteel\n7,1\n*ELEMENT_SHELL\n1,7,1,2,5,4\n2,7,2,3,6,5\n".to_owned() + &k_sets(10)),
        ("ranges", sets("*SET_NODE_LIST_GENERATE_TITLE\nraceway\n         1\n         1         3\n*SET_NODE_LIST_GENERATE_TITLE\nfit\n         2\n         4         4         5         6\n")),
        ("steps", sets("*SET_NODE_LIST_GENERATE_INCREMENT_TITLE\nraceway\n         1\n         1         3         1\n*SET_NODE_LIST_GENERATE_INCREMENT_TITLE\nfit\n         2\n         4         6         2\n         5         5\n")),
        ("no list in the name", sets("*SET_NODE_TITLE\nraceway\n         1\n         1         2         3\n*set_node_title\nfit\n         2\n         4         5         6\n")),
        ("columns", sets("*SET_NODE_COLUMN_TITLE\nraceway\n         1\n         1       1.0\n         2       1.0\n         3\n*SET_NODE_LIST_TITLE\nfit\n         2\n         4         5         6\n")),
        ("sets of sets", sets("*SET_NODE_LIST\n         1\n         1         2\n*SET_NODE_LIST\n         3\n         3\n*SET_NODE_ADD_TITLE\nraceway\n         4\n         1         3\n*SET_NODE_LIST_TITLE\nfit\n         2\n         4         5         6\n")),
        ("general sets", sets("*SET_NODE_GENERAL_TITLE\nraceway\n         1\nNODE               1         2\nNODE               3\n*SET_NODE_LIST_TITLE\nfit\n         2\n         4         5         6\n")),
        ("masses", sets("*ELEMENT_MASS\n       1       1             0.1       0\n") .replace("*END\n", "") + &k_sets(10)),
    ] {
        check(name, Deck::LsDyna, text.as_bytes(), "steel");
    }
    let text = sets("*ELEMENT_MASS\n       1       1             0.1       0\n*PART_CONTACT\nother\n         9\n       0.1\n").replace("*END\n", "") + &k_sets(10);
    let read = check("notes", Deck::LsDyna, text.as_bytes(), "steel");
    assert_eq!(
        read.notes,
        [
            "line 16: `*ELEMENT_MASS` is passed over, as its elements have no area",
            "line 18: of `*PART_CONTACT` only title and number are read"
        ]
    );
    // A part without a title, and two sets of one.
    let text = standard().replace("steel\n", "\n") + &k_sets(10).replace("fit", "raceway");
    let read = Deck::LsDyna.read(&text).expect("a mesh");
    assert_eq!(
        (read.mesh.bodies[0].name.as_str(), read.node_sets["raceway"].len(), read.node_sets["set 2"].len()),
        ("part 7", 3, 3)
    );
    let why =
        Deck::LsDyna.read(&standard().replace("       4\n", "       4       9\n")).expect_err("a fifth node");
    assert!(why.what.contains("between its corners"), "{why}");
}

#[test]
fn issue_gmsh_names_sets_of_lsdyna_in_comments() {
    let text = "$# LS-DYNA Keyword file created by Gmsh
*KEYWORD
*TITLE
 two.key
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 2, 0, 0
4, 0, 1, 0
5, 1, 1, 0
6, 2, 1, 0
*ELEMENT_BEAM
$#SET_ELEMENT=raceway1
1, 1000001, 1, 2
2, 1000001, 2, 3
*ELEMENT_SHELL
$#SET_ELEMENT=steel1
3, 2000001, 1, 2, 5, 4
4, 2000001, 2, 3, 6, 5
*SET_NODE_LIST
$# raceway
1
1, 2, 3
*SET_NODE_LIST
$# fit
2
4, 5, 6
*END
";
    for text in [text.to_owned(), text.replace('\n', "\r\n"), text.replace('\n', "\r"), text.to_lowercase()] {
        check("Gmsh", Deck::LsDyna, text.as_bytes(), "");
    }
    // The headings that LS-PrePost writes there are no names.
    let other =
        text.replace("created by Gmsh", "by LS-PrePost").replace("$# raceway", "$#     sid       da1");
    let read = Deck::LsDyna.read(&other).expect("a mesh");
    assert_eq!(read.node_sets.keys().collect::<Vec<_>>(), ["set 1", "set 2"]);
}

#[test]
fn issue_lines_are_those_of_the_included_file() {
    let text = format!(
        "*HEADING\n** *INCLUDE, INPUT=part.inp\n{}*NSET, NSET=raceway\n1, 2, 3\n*NSET, NSET=fit\n4, 5, \
         6\n*FILM\n",
        included("**", "part.inp", &format!("{INP}*SURFACE\n"))
    );
    let read = check("included", Deck::Abaqus, text.as_bytes(), "steel");
    assert_eq!(read.notes, ["`part.inp`, line 11: `*SURFACE` is not read", "line 7: `*FILM` is not read"]);
    let why = Deck::Abaqus.read(&text.replace("2, 1., 0.", "2, 1., z")).expect_err("damaged");
    assert_eq!((why.file.as_deref(), why.line), (Some("part.inp"), 3));
    assert_eq!(why.to_string(), "`part.inp`, line 3: `z` is no number");
    // The format of an included keyword file ends with it.
    let inner = included("$", "a.k", &k("*KEYWORD I10=Y", "", "", [10, 16, 10]));
    check("included", Deck::LsDyna, format!("*KEYWORD\n{inner}{}", k_sets(10)).as_bytes(), "steel");
}

/// The mesh in the formats of Gmsh, with `raceway` gone through backwards and in a second group, too.
fn msh(version: &str, binary: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let text = |out: &mut Vec<u8>, words: &str| out.extend(words.as_bytes());
    let int = |out: &mut Vec<u8>, value: i32| {
        if binary { out.extend(value.to_le_bytes()) } else { out.extend(format!("{value} ").bytes()) }
    };
    let count = |out: &mut Vec<u8>, value: u64| {
        if binary { out.extend(value.to_le_bytes()) } else { out.extend(format!("{value} ").bytes()) }
    };
    let real = |out: &mut Vec<u8>, value: f64| {
        if binary { out.extend(value.to_le_bytes()) } else { out.extend(format!("{value} ").bytes()) }
    };
    let end = |out: &mut Vec<u8>| {
        if !binary {
            out.push(b'\n');
        }
    };
    text(&mut out, &format!("$MeshFormat\n{version} {} 8\n", u8::from(binary)));
    if binary {
        out.extend(1_i32.to_le_bytes());
        out.push(b'\n');
    }
    text(
        &mut out,
        "$EndMeshFormat\n$PhysicalNames\n4\n1 3 \"wetted\"\n1  4  \"raceway\"\n1 5 \"fit\"\n2 \
         1 \"steel\"\n$EndPhysicalNames\n",
    );
    let lines = [(1, 1, 2), (1, 2, 3), (2, 4, 5), (2, 5, 6)];
    let quads = [[1, 2, 5, 4], [2, 3, 6, 5]];
    if version == "2.2" {
        text(&mut out, "$Nodes\n6\n");
        for (n, [x, y]) in (1..).zip(NODES) {
            int(&mut out, n);
            [x, y, 0.0].iter().for_each(|value| real(&mut out, *value));
            end(&mut out);
        }
        // Elements of the first line are in two groups, and stand twice.
        let mut elements: Vec<(i32, i32, i32, Vec<i32>)> = Vec::new();
        for (curve, a, b) in lines {
            if curve == 1 {
                elements.push((1, -3, 1, vec![a, b]));
            }
            elements.push((1, if curve == 1 { -4 } else { 5 }, curve, vec![a, b]));
        }
        elements.extend(quads.iter().map(|quad| (3, 1, 1, quad.to_vec())));
        elements.push((3, 9, 1, quads[0].to_vec()));
        text(&mut out, &format!("\n$EndNodes\n$Elements\n{}\n", elements.len()));
        for (number, (kind, group, entity, nodes)) in (1..).zip(elements) {
            let head = if binary { vec![kind, 1, 2, number] } else { vec![number, kind, 2] };
            head.iter().chain(&[group, entity]).chain(&nodes).for_each(|value| int(&mut out, *value));
            end(&mut out);
        }
        text(&mut out, "\n$EndElements\n");
        return out;
    }
    let new = version == "4.1";
    text(&mut out, "$Entities\n");
    [1, 2, 1, 0].iter().for_each(|many| count(&mut out, *many));
    end(&mut out);
    int(&mut out, 1);
    (0..if new { 3 } else { 6 }).for_each(|_| real(&mut out, 0.0));
    count(&mut out, 0);
    end(&mut out);
    for (tag, groups, boundary) in [(1, &[-3, -4][..], &[2, -3][..]), (2, &[5], &[]), (1, &[1], &[1, 2])] {
        int(&mut out, tag);
        (0..6).for_each(|n| real(&mut out, f64::from(n) - 0.5));
        for tags in [groups, boundary] {
            count(&mut out, tags.len() as u64);
            tags.iter().for_each(|tag| int(&mut out, *tag));
        }
        end(&mut out);
    }
    text(&mut out, "\n$EndEntities\n$Nodes\n");
    let sizes = |out: &mut Vec<u8>, blocks: u64, all: u64| {
        count(out, blocks);
        count(out, all);
        if new {
            count(out, 1);
            count(out, all);
        }
        end(out);
    };
    sizes(&mut out, 2, 6);
    // Nodes of the curve have a parameter.
    for (dimension, nodes) in [(1, 0..3), (2, 3..6)] {
        let head = if new { [dimension, 1] } else { [1, dimension] };
        head.iter().chain(&[i32::from(dimension == 1)]).for_each(|value| int(&mut out, *value));
        count(&mut out, 3);
        end(&mut out);
        if new {
            nodes.clone().for_each(|n| count(&mut out, n + 1));
            end(&mut out);
        }
        for n in nodes {
            if !new {
                int(&mut out, n as i32 + 1);
            }
            let [x, y] = NODES[n as usize];
            [x, y, 0.0].iter().for_each(|value| real(&mut out, *value));
            if dimension == 1 {
                real(&mut out, 0.25);
            }
            end(&mut out);
        }
    }
    text(&mut out, "\n$EndNodes\n$Periodic\n0\n$EndPeriodic\n$Elements\n");
    sizes(&mut out, 3, 6);
    let mut number = 0;
    let blocks = [
        (1, 1, 1, vec![vec![1, 2], vec![2, 3]]),
        (1, 2, 1, vec![vec![4, 5], vec![5, 6]]),
        (2, 1, 3, quads.iter().map(|quad| quad.to_vec()).collect()),
    ];
    for (dimension, tag, kind, elements) in blocks {
        let head = if new { [dimension, tag, kind] } else { [tag, dimension, kind] };
        head.iter().for_each(|value| int(&mut out, *value));
        count(&mut out, elements.len() as u64);
        end(&mut out);
        for nodes in elements {
            number += 1;
            for value in std::iter::once(number).chain(nodes) {
                if new { count(&mut out, value as u64) } else { int(&mut out, value) }
            }
            end(&mut out);
        }
    }
    text(&mut out, "\n$EndElements\n");
    out
}

/// A binary file as a machine with the other order of bytes writes it: every number the other way round.
fn turned(bytes: &[u8], version: &str) -> Vec<u8> {
    let (mut out, mut at) = (Vec::new(), 0);
    // The numbers of a section have these widths; a line of text stands before those of format 2.2.
    let mut section = |name: &str, widths: &[usize]| {
        let head = format!("${name}\n");
        let start =
            bytes[at..].windows(head.len()).position(|w| w == head.as_bytes()).unwrap() + at + head.len();
        out.extend(&bytes[at..start]);
        at = start;
        if version == "2.2" || name == "MeshFormat" {
            let line = bytes[at..].iter().position(|byte| *byte == b'\n').unwrap() + 1;
            out.extend(&bytes[at..at + line]);
            at += line;
        }
        for width in widths {
            out.extend(bytes[at..at + width].iter().rev());
            at += width;
        }
    };
    section("MeshFormat", &[4]);
    if version == "2.2" {
        section("Nodes", &[4, 8, 8, 8].repeat(6));
        // Six lines of two nodes, two squares, and one of them again.
        section("Elements", &[4].repeat(6 * 8 + 3 * 10));
    } else {
        let tags = |groups: usize, bounds: usize| {
            [vec![4], vec![8; 7], vec![4; groups], vec![8], vec![4; bounds]].concat()
        };
        let point = vec![4, 8, 8, 8, 8];
        section("Entities", &[vec![8; 4], point, tags(2, 2), tags(1, 0), tags(1, 2)].concat());
        let head = || vec![4, 4, 4, 8];
        let block = |own: usize| [head(), vec![8; 3 + 3 * own]].concat();
        section("Nodes", &[vec![8; 4], block(4), block(3)].concat());
        let of = |numbers: usize| [head(), vec![8; numbers]].concat();
        section("Elements", &[vec![8; 4], of(6), of(6), of(10)].concat());
    }
    out.extend(&bytes[at..]);
    out
}

#[test]
fn issue_gmsh_files_of_the_other_order_of_bytes() {
    for version in ["2.2", "4.1"] {
        let bytes = msh(version, true);
        check(version, Deck::Gmsh, &turned(&bytes, version), "steel");
        // Neither the one nor the other.
        let damaged = String::from_utf8_lossy(&bytes).find('\n').unwrap() + 1;
        let place = damaged + bytes[damaged..].iter().position(|byte| *byte == b'\n').unwrap() + 1;
        let mut bytes = bytes;
        bytes[place] = 7;
        assert!(Deck::Gmsh.read_bytes(&bytes).expect_err("no one").what.contains("number 1"));
    }
}

#[test]
fn issue_gmsh_nodes_with_parameters_and_partitions() {
    // As Gmsh 4.15 writes them with `Mesh.SaveParametric` in format 2.2.
    let text = String::from_utf8(msh("2.2", false)).expect("text");
    let places = ["0 1", "1 2 0.5", "0 2", "1 4 0.25", "2 1 0.5 0.5", "3 1"];
    let mut rows = places.iter();
    let text: Vec<String> = (text.lines())
        .map(|line| match line.split_whitespace().count() {
            4 => format!("{line}{}", rows.next().expect("six nodes")),
            _ => line.replace("$Nodes", "$ParametricNodes").replace("$EndNodes", "$EndParametricNodes"),
        })
        .collect();
    check("parameters", Deck::Gmsh, text.join("\n").as_bytes(), "steel");
    // Each square in a partition; `raceway` is curve 3 in one and 4 in the other.
    let partitions = r#"$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "raceway"
1 2 "fit"
2 1 "steel"
$EndPhysicalNames
$Entities
1 2 1 0
1 0 0 0 0
1 0 0 0 2 0 0 1 1 0
2 0 1 0 2 1 0 1 2 0
1 0 0 0 2 1 0 1 1 2 1 2
$EndEntities
$PartitionedEntities
2
1 9 1
1 4 2 0
2 0 1 1 1 0 0 0 0
3 1 1 1 1 0 0 0 1 0 0 1 1 0
4 1 1 1 2 1 0 0 2 0 0 1 1 0
5 1 2 2 1 2 0 1 0 2 1 0 1 2 0
6 2 1 2 1 2 1 0 0 1 1 0 0 0
2 2 1 1 1 0 0 0 1 1 0 1 1 2 3 5
3 2 1 1 2 1 0 0 2 1 0 1 1 0
$EndPartitionedEntities
$Nodes
1 6 1 6
2 2 0 6
1 2 3 4 5 6
0 0 0  1 0 0  2 0 0  0 1 0  1 1 0  2 1 0
$EndNodes
$GhostElements
0
$EndGhostElements
$Elements
6 7 1 7
1 3 1 1  1 1 2
1 4 1 1  2 2 3
1 5 1 2  3 4 5  4 5 6
1 6 1 1  5 2 5
2 2 3 1  6 1 2 5 4
2 3 3 1  7 2 3 6 5
$EndElements
"#;
    check("partitions", Deck::Gmsh, partitions.as_bytes(), "steel");
}

#[test]
fn issue_gmsh_versions_text_and_binary() {
    for (version, binary) in
        [("2.2", false), ("2.2", true), ("4.0", false), ("4.0", true), ("4.1", false), ("4.1", true)]
    {
        let name = format!("{version} {binary}");
        let bytes = msh(version, binary);
        let read = check(&name, Deck::Gmsh, &bytes, "steel");
        assert_eq!(read.node_sets["wetted"], read.node_sets["raceway"], "{name}");
        for cut in 0..bytes.len() - 20 {
            if let Err(why) = Deck::Gmsh.read_bytes(&bytes[..cut]) {
                assert!(why.line > 0, "{name} cut at {cut}: {why}");
            }
        }
    }
    let text = String::from_utf8(msh("4.1", false)).expect("text");
    let far = text
        .replace("2 3 6 5", "2 3 6 7")
        .replace("2 1 3 2 \n5 1 2 5 4 \n6 2 3 6 5", "2 1 3 2 \n5 1 2 5 4 \n6 2 3 6 7");
    let why = Deck::Gmsh.read(&far).expect_err("no node 7");
    let line = 1 + far.lines().position(|line| line == "6 2 3 6 7 ").expect("the line");
    assert_eq!((why.line, why.what.as_str()), (line, "there is no node 7"));
    let big = text.replace("$MeshFormat\n4.1 0 8", "$MeshFormat\n4.1 0 3");
    assert!(Deck::Gmsh.read(&big).expect_err("a size").what.contains("no head of a Gmsh file"));
    let curved = text.replace("2 1 3 2 \n", "2 1 16 2 \n");
    assert!(Deck::Gmsh.read(&curved).expect_err("eight nodes").what.contains("first order"));
}

/// The same mesh as meshio 5.3.5 writes it, where the interpreter in STRIBECK_PYTHON (or python3) has it.
#[test]
fn peer_meshio_writes_every_dialect() {
    let Some(python) = python_with(&["meshio"]) else { return };
    let folder = Scratch::create("dialects");
    let script = "import meshio, numpy as np
points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
cells = [('line', np.array([[0, 1], [1, 2]])), ('line', np.array([[3, 4], [4, 5]])), ('quad', np.array([[0, \
1, 4, 3], [1, 2, 5, 4]]))]
none = np.array([], int)
sets = dict(point_sets={'raceway': np.arange(3), 'fit': np.arange(3, 6)}, cell_sets={'steel': [none, none, \
np.arange(2)], 'curve': [np.arange(2), none, none]})
meshio.Mesh(points, cells, **sets).write('a.inp')
groups = dict(field_data={'raceway': np.array([4, 1]), 'fit': np.array([5, 1]), 'steel': np.array([1, 2])},
              cell_data={'gmsh:physical': [np.array([4, 4]), np.array([5, 5]), np.array([1, 1])], \
              'gmsh:geometrical': [np.array([1, 1]), np.array([2, 2]), np.array([1, 1])]},
              point_data={'gmsh:dim_tags': np.array([[1, 1]] * 3 + [[1, 2]] * 3)})
mesh = meshio.Mesh(points, cells, **groups)
for name in ['gmsh22', 'gmsh']:
    for binary in [False, True]:
        meshio.write(f'{name}_{binary}.msh', mesh, file_format=name, binary=binary)
print('written')";
    let output =
        Command::new(&python).current_dir(folder.path()).args(["-c", script]).output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
    for (name, deck, body) in [
        ("a.inp", Deck::Abaqus, "steel"),
        ("gmsh22_False.msh", Deck::Gmsh, "steel"),
        ("gmsh22_True.msh", Deck::Gmsh, "steel"),
        // It writes the groups of curves into version 4.1, and none of surfaces that have no nodes of their
        // own.
        ("gmsh_False.msh", Deck::Gmsh, "surface 1"),
        ("gmsh_True.msh", Deck::Gmsh, "surface 1"),
    ] {
        check(name, deck, &std::fs::read(folder.join(name)).expect("it is there"), body);
    }
}
