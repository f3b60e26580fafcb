//! Habits from other formats and languages, and files that cannot be read.

use super::*;

#[test]
fn issue_habits_of_other_formats_are_answered_in_ron() {
    for (text, message, how) in [
        (
            "{\"name\": \"x\", \"bearing\": {\"rollers\": 24}}",
            "a group `( … )` is expected",
            "round brackets",
        ),
        ("# a bearing\n(name: \"x\")", "cannot be read", "`//` begins a comment"),
        ("(bearing: {rollers: 24})", "a group `( … )` is expected", "a group `( … )`"),
        ("(bearing: (rollers = 24))", "cannot be read", "`name: value`"),
        ("(\"name\": \"x\")", "cannot be read", "without quotes"),
        ("(operation: (load_n: 50,0))", "the name of a field is expected", "a decimal point"),
    ] {
        let problem = only(parse(text));
        assert!(problem.message.contains(message), "{text}\n{problem}");
        assert!(problem.to_string().contains(how), "{text}\n{problem}");
    }
    for text in ["name: x\nbearing:\n  rollers: 24\n", "name = \"x\"\n[bearing]\nrollers = 24\n"] {
        assert!(only(parse(text)).message.contains("cannot be read"), "{text}");
    }
}

#[test]
fn behaves_a_value_of_the_wrong_type_shows_what_is_allowed() {
    for (text, allowed, proposed) in [
        ("(bearing: (rollers: 24.5))", "a whole number, 3 to 400", ""),
        ("(bearing: (rollers: -3))", "a whole number, 3 to 400", ""),
        ("(bearing: (rollers: \"24\"))", "a whole number, 3 to 400", "24"),
        ("(bearing: (rollers: 99999999999999999999999))", "a whole number, 3 to 400", ""),
        ("(operation: (load_n: \"x\"))", "a number, more than 0, at most 1e9 N", ""),
        ("(operation: (load_n: \"900\"))", "a number, more than 0, at most 1e9 N", "900"),
        ("(operation: (load_n: NaN))", "more than 0, at most 1e9 N", ""),
        ("(operation: (load_n: -inf))", "more than 0, at most 1e9 N", ""),
        ("(bearing: (first_roller_deg: 454))", "-360 to 360 °", ""),
        ("(mesh: (outer_facets: none))", "a whole number or `None`, 16 to 1000000", "None"),
        ("(contact: (method: \"collocated\"))", "`collocated`, `integrated`", "collocated"),
        ("(name: quick)", "a text in double quotes", "\"quick\""),
    ] {
        let problem = only(parse(text));
        assert_eq!(problem.allowed, allowed, "{text}\n{problem}");
        if proposed.is_empty() {
            assert_eq!(problem.suggestion, "", "{text}");
            continue;
        }
        assert!(problem.suggestion.starts_with(&format!("`{proposed}` ")), "{text}\n{problem}");
        let repaired = text.replacen(&mark(&problem).2, proposed, 1);
        assert!(parse(&repaired).is_ok(), "{repaired}");
    }
}

#[test]
fn issue_allowed_fields_are_listed_once() {
    for text in ["(operation: (qqq: 1))", "(qqq: 1)"] {
        let shown = only(parse(text)).to_string();
        let name = if text.starts_with("(q") { "`guards`" } else { "`gravity_m_s2`" };
        assert_eq!(shown.matches(name).count(), 1, "{shown}");
    }
    for argument in ["operation.qqq=1", "qqq=1"] {
        let shown = only(Scene::default().with_overrides(&[argument])).to_string();
        let name = if argument.starts_with('q') { "`guards`" } else { "`operation.gravity_m_s2`" };
        assert_eq!(shown.matches(name).count(), 1, "{shown}");
    }
}

#[test]
fn issue_a_file_that_cannot_be_read_is_not_answered_by_check_the_path() {
    let folder = Scratch::create("unreadable");
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("writable");
    let refuse = |name: &str| only(Scene::read(folder.join(name))).to_string();
    write("quick.ron", b"()");
    write("utf16.txt", b"\xff\xfe(\0)\0");
    write("latin1.txt", b"(\n// \xfc\n)");
    write("binary.txt", b"\x93NUMPY\x01\0");
    for (name, message, advice) in [
        ("", "is a folder", "quick.ron"),
        ("utf16.txt", "UTF-16", "save it as UTF-8"),
        ("latin1.txt", "byte 0xfc in line 2", "save it as UTF-8"),
        ("binary.txt", "not a text file", "something else"),
        ("quick", "no such file", "quick.ron"),
        ("quick.ron/x", "is a file, not a folder", "check the path"),
        ("zzz", "no such file", "check the path"),
    ] {
        let shown = refuse(name);
        assert!(shown.contains(message) && shown.contains(advice), "{name}\n{shown}");
    }
}
