//! LS-DYNA: cards in columns of all widths, and names of sets that Gmsh writes into comments.

use stribeck_mesh::decks::Deck;

use crate::{NODES, check};

/// Nodes and elements of an LS-DYNA file in columns of these widths.
pub(crate) fn k(keyword: &str, node: &str, shell: &str, widths: [usize; 3]) -> String {
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

pub(crate) fn k_sets(width: usize) -> String {
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
