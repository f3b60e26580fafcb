//! Gmsh: formats 2.2, 4.0 and 4.1, as text and binary in either byte order; partitions.

use stribeck_mesh::decks::Deck;

use crate::{NODES, check};

/// The mesh in the formats of Gmsh, with `raceway` reversed and in a second group, too.
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
        "$EndMeshFormat\n$PhysicalNames\n4\n1 3 \"wetted\"\n1  4  \"raceway\"\n1 5 \"fit\"\n2 1 \
         \"steel\"\n$EndPhysicalNames\n",
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
