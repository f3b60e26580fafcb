//! Campaign files: the scenes that they define, and the errors that they get.

use std::collections::BTreeMap;

use super::*;
use stribeck_testing::assert_has;

fn parse(text: &str) -> Result<Campaign, String> {
    Campaign::parse(text, "a.ron", Path::new("")).map_err(|why| why.to_string())
}

#[test]
fn by_hand_a_grid_has_every_value_with_every_other() {
    let text = "(name: \"g\", starts: 2, variants: grid([
        (field: \"operation.load_n\", values: [10000, 20000]),
        (field: \"bearing\", values: [\"NU 205\", \"NU 206\", \"6205\"]),
    ]))";
    let campaign = parse(text).unwrap();
    assert_eq!(campaign.runs.len(), 12);
    let last = &campaign.runs[11];
    assert_eq!(
        (last.variant, last.start, &last.values[..]),
        (6, 2, &["20000".to_owned(), "\"6205\"".to_owned()][..])
    );
    let scene = last.scene.as_ref().unwrap();
    assert_eq!((scene.bearing.designation.as_str(), scene.operation.load_n), ("6205", 20_000.0));
    assert_ne!(scene.hash(), campaign.runs[10].scene.as_ref().unwrap().hash());
    assert_eq!(campaign.runs[10].split, last.split);
}

#[test]
fn invariant_designs_fill_their_ranges_and_repeat() {
    for design in ["latin_hypercube", "sobol"] {
        let text = format!(
            "(name: \"d\", seed: 7, variants: {design}(count: 64, over: [
            (field: \"operation.load_n\", from: 1000, to: 100000, log: true),
            (field: \"operation.speed_rpm\", from: 100, to: 900),
            (field: \"contact.surface\", values: [facet, arc])]))"
        );
        let (a, b) = (parse(&text).unwrap(), parse(&text).unwrap());
        assert!(a.runs.iter().zip(&b.runs).all(|(a, b)| a.values == b.values && a.split == b.split));
        // Each eighth of the range holds eight of the 64, by construction of both.
        let mut eighths = [0; 8];
        for run in &a.runs {
            let rpm: f64 = run.values[1].parse().unwrap();
            eighths[(((rpm - 100.0) / 100.0) as usize).min(7)] += 1;
            assert!(run.scene.is_ok(), "{:?}", run.scene);
        }
        assert_eq!(eighths, [8; 8], "{design}");
        let arcs = a.runs.iter().filter(|run| run.values[2] == "arc").count();
        assert_eq!(arcs, 32, "{design}");
    }
}

#[test]
fn behaves_a_scene_that_cannot_be_is_a_row_with_its_reason() {
    let text = "(name: \"x\", variants: grid([(field: \"defect.depth_mm\", values: [0.2, 9])]))";
    let campaign = parse(text).unwrap();
    assert!(campaign.runs[0].scene.is_ok());
    let why = campaign.runs[1].scene.as_ref().unwrap_err();
    for word in ["defect.depth_mm", "a.ron:1:70"] {
        assert!(why.contains(word) && !why.contains("--set"), "{word} is not in\n{why}");
    }
}

/// 60 of 200 runs were refused without a word, all of them spalls of two sizes, so that the name of a bearing gave
/// its label away.
#[test]
fn issue_refused_runs_are_counted_by_reason_and_label() {
    let text = "(name: \"x\", starts: 2, variants: grid([
        (field: \"bearing\", values: [\"NU 205\", \"6205\"]),
        (field: \"defect\", values: [None, (depth_mm: 9.0), (ring: inner, depth_mm: 9.0)]),
    ]))";
    let campaign = parse(text).unwrap();
    let refused = campaign.refused();
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for (label, count) in refused.iter().flat_map(|refused| &refused.labels) {
        *counts.entry((&label.bearing, &label.fault)).or_default() += count;
    }
    for bearing in ["NU 205", "6205"] {
        assert_eq!(
            (counts[&(bearing, "inner_race")], counts[&(bearing, "outer_race")]),
            (2, 2),
            "{counts:?}"
        );
        let lost =
            format!("{bearing} is always healthy, and its name gives the label away: of other runs 4 of 4");
        assert!(
            campaign.lost_labels().iter().any(|said| said.starts_with(&lost)),
            "{:?}",
            campaign.lost_labels()
        );
    }
    assert!(refused[0].reason.starts_with("the defect, 9 mm deep, is too deep"), "{refused:?}");
    assert!(parse(&text.replace("9.0", "0.1")).unwrap().lost_labels().is_empty());
}

/// A load of 1000 N became 1500 to 3380 N in silence.
#[test]
fn issue_fields_that_a_bearing_replaces_are_named() {
    let scratch = stribeck_testing::Scratch::create("campaign-bearings");
    std::fs::write(scratch.join("a.ron"), "(bearing: \"NU 205\", operation: (load_n: 1000.0))").unwrap();
    let of = |set: &str| {
        let text = format!(
            "(name: \"x\", scene: \"a.ron\", set: [{set}], variants: grid([(field: \"bearing\", values: [\"NU \
             206\", \"NU 207\"])]))"
        );
        Campaign::parse(&text, "c.ron", scratch.path()).unwrap()
    };
    let [replaced] = &of("").replaced[..] else { panic!("{:?}", of("").replaced) };
    let loads =
        of("").runs.iter().map(|run| run.scene.as_ref().unwrap().operation.load_n).collect::<Vec<_>>();
    assert_eq!((replaced.field.as_str(), replaced.now.len()), ("operation.load_n", 2));
    assert!(replaced.now.iter().zip(loads).all(|(now, load)| now.parse() == Ok(load)), "{replaced:?}");
    let kept = of("\"operation.load_n=1000\"");
    assert!(kept.replaced.is_empty());
    assert!(kept.runs.iter().all(|run| run.scene.as_ref().unwrap().operation.load_n == 1000.0));
}

#[test]
fn by_hand_a_range_of_a_seed_has_its_whole_numbers_equally_often() {
    let of = |from: f64, to: f64| {
        parse(&format!(
            "(name: \"x\", variants: latin_hypercube(count: 8, over: [(field: \"bearing.diameter_seed\", from: \
             {from}, to: {to})]))"
        ))
    };
    let mut seeds: Vec<String> = of(1.0, 4.0).unwrap().runs.iter().map(|run| run.values[0].clone()).collect();
    seeds.sort();
    assert_eq!(seeds, ["1", "1", "2", "2", "3", "3", "4", "4"]);
    assert_has(&of(1.2, 1.8).unwrap_err(), &["a.ron:1:", "whole number", "none lies in its range"]);
}

#[test]
fn behaves_a_label_names_every_damaged_part() {
    let scene = Scene::default().with_overrides(&[
        "film=None",
        "defect=None",
        "defects=[(on: roller(3), form: dent(length_mm: 2.2, depth_mm: 0.04)), (on: inner, form: \
         spall(length_mm: 4.0)), (on: roller(5), form: missing)]",
    ]);
    let label = Label::of(&scene.unwrap());
    assert_eq!(label.fault, "inner_race+rolling_element+missing_rolling_element");
}

#[test]
fn refuses_what_no_variant_repairs() {
    let text = "(name: \"x\", set: [\"mesh.size_mm=2.0\", \"solver.duration_ms=-1\"],
        variants: grid([(field: \"operation.load_n\", values: [10000, 20000, -3])]))";
    let why = parse(text).unwrap_err();
    for word in ["a.ron:1:39", "`solver.duration_ms` is -1", "= allowed: more than 0"] {
        assert!(why.contains(word) && !why.contains("--set"), "{word} is not in\n{why}");
    }
}

#[test]
fn invariant_equal_scenes_are_in_one_part_however_they_are_written() {
    let text = |loads: &str, bearings: &str| {
        format!(
            "(name: \"x\", starts: 2, variants: grid([(field: \"operation.load_n\", values: {loads}),
             (field: \"bearing\", values: {bearings})]))"
        )
    };
    let [a, b] = [("[10000, 2e4]", "[\"NU 205\", \"6205\"]"), ("[1e4, 20000.0]", "[\"nu 205\", \"6205\"]")]
        .map(|(loads, bearings)| parse(&text(loads, bearings)).unwrap());
    for (a, b) in a.runs.iter().zip(&b.runs) {
        assert_eq!((a.split, a.scene.as_ref().unwrap()), (b.split, b.scene.as_ref().unwrap()));
    }
}

/// All runs with a spall on the inner raceway were in one part.
#[test]
fn issue_each_fault_of_each_bearing_is_in_every_part() {
    let text = "(name: \"x\", starts: 2, variants: grid([
        (field: \"defect.ring\", values: [inner, outer]),
        (field: \"bearing\", values: [\"NU 205\", \"6205\"]),
        (field: \"operation.load_n\", values: [1000, 1100, 1200, 1300, 1400, 1500, 1600, 1700, 1800, 1900]),
    ]))";
    let campaign = parse(text).unwrap();
    for ring in ["inner", "outer"] {
        for bearing in ["NU 205", "6205"] {
            let of = |run: &&Variant| run.values[0].contains(ring) && run.values[1].contains(bearing);
            let count = |part: &str| campaign.runs.iter().filter(of).filter(|run| run.split == part).count();
            // 0.7, 0.15 and 0.15 of ten, two starts each.
            assert_eq!(["train", "validation", "test"].map(count), [14, 4, 2], "{ring} {bearing}");
        }
    }
}

#[test]
fn invariant_variants_share_no_start() {
    let text = "(name: \"x\", starts: 3, variants: grid([(field: \"operation.load_n\", values: [10000, \
        20000, 30000])]))";
    let campaign = parse(text).unwrap();
    let angle = |run: &Variant| run.scene.as_ref().unwrap().bearing.first_roller_deg;
    let mut angles: Vec<f64> = campaign.runs.iter().map(angle).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    assert_eq!(angles.len(), 9);
}

#[test]
fn refuses_campaigns_that_cannot_be() {
    let with = |rest: &str| format!("(name: \"x\",\n{rest})");
    let field = |name: &str| with(&format!("variants: grid([(field: \"{name}\", values: [1])])"));
    for (text, says) in [
        (with(""), &["a.ron:", "`variants`"][..]),
        ("(name: \"x y\", variants: grid([]))".to_owned(), &["a.ron:1:8", "folder's name"]),
        (
            with("variants: grid([(field: \"operation.load_n\", from: 1, to: 2)])"),
            &["a.ron:2:17", "a grid takes"],
        ),
        (
            with("variants: sobol(count: 0, over: [])"),
            &["a.ron:2:24", "`variants.count` is 0", "1 to 1000000"],
        ),
        (with("variants: sobol(count: 2, over: [])"), &["a.ron:2:11", "2 points over 0 fields"]),
        (
            with("variants: sobol(count: 2, over: [(field: \"mesh.size_mm\", from: 2, to: 1)])"),
            &["a.ron:2:34", "below `to`"],
        ),
        (with("variants: sobol(count: 2, over: [], scramble: true)"), &["a.ron:2:", "`scramble`", "`over`"]),
        (with("variants: sobl(count: 2, over: [])"), &["`sobl`", "did you mean `sobol`?"]),
        (with("variants: table(\"none.csv\")"), &["none.csv"]),
        (with("variants: grid([])"), &["a.ron:2:11", "names no field"]),
        (with("variants: grid([(field: \"mesh.size_mm\", values: [])])"), &["a.ron:2:17", "one at least"]),
        // Refused before memory for them is allocated.
        (
            with(
                "variants: latin_hypercube(count: 1000000000000000, over: [(field: \"seed\", from: 1, to: \
                 2)])",
            ),
            &["a.ron:2:34", "`variants.count` is 1e15", "1 to 1000000"],
        ),
        (
            with("variants: latin_hypercube(count: 4.5, over: [])"),
            &["a.ron:2:34", "`variants.count` is `4.5`", "a whole number, 1 to 1000000"],
        ),
        (with("seed: 1.5, variants: grid([])"), &["a.ron:2:7", "`seed` is `1.5`", "a whole number"]),
        (with("starts: -1, variants: grid([])"), &["a.ron:2:9", "`starts` is `-1`", "1 to 10000"]),
        (with("starts: 0, variants: grid([])"), &["a.ron:2:9", "`starts`"]),
        (with("split: (train: 1, validation: 1, test: 1), variants: grid([])"), &["a.ron:2:8", "sums to 3"]),
        (
            with("split: (train: 1.5, validation: -0.5, test: 0), variants: grid([])"),
            &["a.ron:2:8", "1.5, -0.5 and 0", "from 0 to 1"],
        ),
        (
            with(
                "variants: grid([(field: \"operation.load_n\", values: [1]),\n(field: \"operation.load_n\", \
                 values: [2])])",
            ),
            &["a.ron:3:9", "`operation.load_n` is named twice"],
        ),
        (
            with("split: (train: 0.8, test: 0.2), variants: grid([])"),
            &["a.ron:2:", "`split` has no field `validation`", "add `validation: …`"],
        ),
        ("(nam: \"x\")".to_owned(), &["a.ron:1:2", "`nam`", "did you mean `name`?"]),
        (with("bearing: \"NU 205\""), &["a.ron:2:1", "`bearing`", "`set"]),
        (
            field("operation.laod_n"),
            &["a.ron:2:25", "`operation.laod_n`", "did you mean `operation.load_n` [N]?"],
        ),
        (field("load_n"), &["a.ron:2:25", "operation.load_n"]),
        (with("set: [\"seed=1\", \"mesh.size=1.0\"], variants: grid([])"), &["a.ron:2:7", "`seed`"]),
        (
            with("set: [\"cage=None\", \"mesh.size=1.0\"], variants: grid([])"),
            &["a.ron:2:20", "`mesh.size`", "did you mean `mesh.size_mm` [mm]?"],
        ),
        (with("scene: \"no.ron\", variants: grid([])"), &["no.ron", "there is no such file"]),
    ] {
        let why = parse(&text).unwrap_err();
        for word in says {
            assert!(why.contains(word), "{text}: {word} is not in\n{why}");
        }
    }
}

#[test]
fn refuses_values_that_their_field_cannot_have() {
    let grid = |axes: &str| format!("(name: \"x\",\nvariants: grid([\n{axes}\n]))");
    let surface = |values: &str| grid(&format!("(field: \"contact.surface\", values: {values})"));
    for (text, says) in [
        (
            surface("[facet, acr]"),
            &["a.ron:3:44", "`contact.surface` is `acr`", "`facet`, `arc`", "did you mean `arc`?"][..],
        ),
        // All of them at once, each in its place.
        (surface("[acr, arc, fasset]"), &["a.ron:3:37", "a.ron:3:47", "did you mean `facet`?"]),
        (surface("[\"arc\"]"), &["a.ron:3:37", "`arc` (without quotes)"]),
        (
            grid("(field: \"operation.load_n\", values: [10000, true])"),
            &["a.ron:3:45", "`operation.load_n` is `true`, which is not a number"],
        ),
        (grid("(field: \"bearing\", values: [\"NU 205\", \"NV 205\"])"), &["a.ron:3:39", "`NV 205`", "NU"]),
        (
            grid(
                "(field: \"defects\", values: [[], [(on: outer, form: spal(length_mm: 6.0, depth_mm: \
                 0.1))]])",
            ),
            &["a.ron:3:33", "`spal`", "did you mean `spall`?"],
        ),
        // A word beside a bearing that a plane model does not have.
        (
            grid("(field: \"bearing\", values: [\"30205\"]),\n(field: \"contact.surface\", values: [acr])"),
            &["a.ron:4:37", "did you mean `arc`?"],
        ),
        (
            "(name: \"x\", variants: sobol(count: 64, over: [
(field: \"contact.surface\", values: [facet, acr]),
(field: \"contact.friction\", from: 10, to: 20)]))"
                .to_owned(),
            &["a.ron:2:44", "did you mean `arc`?"],
        ),
    ] {
        let why = parse(&text).unwrap_err();
        for word in says {
            assert!(why.contains(word), "{text}: {word} is not in\n{why}");
        }
        assert!(!why.contains("--set"), "{why}");
    }
    // In the order of the file, whichever variant comes first.
    let text = surface("[facet, acr]),\n(field: \"operation.load_n\", values: [much]");
    let why = parse(&text).unwrap_err();
    assert!(why.find("a.ron:3:44").unwrap() < why.find("a.ron:4:38").unwrap(), "{why}");
}

#[test]
fn refuses_cells_that_their_field_cannot_have_in_the_tables_own_lines() {
    let scratch = stribeck_testing::Scratch::create("campaign-cells");
    let table = "operation.load_n, contact.surface\n\n10000, facet\n20000,  acr\nmuch, arc\n";
    std::fs::write(scratch.join("t.csv"), table).unwrap();
    let text = "(name: \"t\", variants: table(\"t.csv\"))";
    let why = Campaign::parse(text, "a.ron", scratch.path()).unwrap_err().to_string();
    assert_has(&why, &["t.csv:4:9", "did you mean `arc`?", "t.csv:5:1", "`much`", "not a number"]);
    for (head, says) in [
        ("operation.load_n, contact.surfac", &["t.csv:1:19", "did you mean `contact.surface`?"][..]),
        ("operation.load_n,\"operation.load_n\"", &["t.csv:1:18", "named twice"]),
        ("\"\",\"operation.load_n\"", &["t.csv", "line 1", "column 1", "row.names"]),
        ("operation.load_n;operation.speed_rpm", &["t.csv", "line 1", "semicolons"]),
    ] {
        std::fs::write(scratch.join("t.csv"), format!("{head}\n1,2\n")).unwrap();
        let why = Campaign::parse(text, "a.ron", scratch.path()).unwrap_err().to_string();
        for word in says {
            assert!(why.contains(word), "{word} is not in\n{why}");
        }
    }
}

#[test]
fn behaves_a_table_as_spreadsheets_write_it() {
    let scratch = stribeck_testing::Scratch::create("campaign-quoted");
    let table = "\u{feff}\"operation.load_n\",\"bearing\",\"contact.surface\",name,output.sensors\r\n\
                 10000,\"NU 205\",\"arc\",\"rig\",\"[(name: \"\"a\"\", angle_deg: \
                 10.0)]\"\r\n20000,6205,facet,b,\"[(name: \"\"b\"\", angle_deg: 5)]\"\r\n";
    std::fs::write(scratch.join("t.csv"), table).unwrap();
    let text = "(name: \"t\", variants: table(\"t.csv\"))";
    let campaign = Campaign::parse(text, "a.ron", scratch.path()).unwrap();
    assert_eq!(campaign.fields[0], "operation.load_n");
    let scenes: Vec<&Scene> = campaign.runs.iter().map(|run| run.scene.as_ref().unwrap()).collect();
    assert_eq!(scenes.iter().map(|s| &*s.bearing.designation).collect::<Vec<_>>(), ["NU 205", "6205"]);
    assert_eq!((&*scenes[0].name, &*scenes[0].output.sensors[0].name), ("rig", "a"));
}

#[test]
fn behaves_values_that_contradict_each_other_are_rows_with_their_reason() {
    // The sensor is there in one variant and missing in the other: no value is misspelt.
    let text = "(name: \"x\", variants: grid([
        (field: \"output.sensors\", values: [[], [(name: \"a\", angle_deg: 10.0)]]),
        (field: \"output.sensors[0].angle_deg\", values: [20.0]),
    ]))";
    let campaign = parse(text).unwrap();
    assert!(campaign.runs[0].scene.as_ref().unwrap_err().contains("has 0 items"));
    assert!(campaign.runs[1].scene.is_ok(), "{:?}", campaign.runs[1].scene);
}

#[test]
fn behaves_campaigns_of_the_repository_have_no_variant_that_cannot_be() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/campaigns");
    let files = std::fs::read_dir(folder).expect("fixtures").flatten().map(|entry| entry.path());
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "ron"));
    let mut runs = 0;
    // More scenes take seconds, and are made in the same way: these are every bearing in every class.
    for path in files {
        let campaign = Campaign::read_first(&path, None, 280).unwrap_or_else(|why| panic!("{why}"));
        for run in &campaign.runs {
            assert!(run.scene.is_ok(), "{}: {:?}", path.display(), run.scene);
        }
        runs += campaign.runs.len();
    }
    assert!(runs >= 64 + 36 + 32 + 16 + 4, "{runs}");
}

#[test]
fn behaves_the_guide_shows_the_campaigns_of_the_repository() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let read = |path: &str| std::fs::read_to_string(root.join(path)).expect("a file of the repository");
    let page = read("docs/guide/src/campaign_file.md");
    for name in ["starts.ron", "spalls.ron", "quick64.ron", "duty.ron", "duty.csv"] {
        let text = read(&format!("fixtures/campaigns/{name}"));
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("//")).collect();
        assert!(page.contains(&format!("{name}`:\n\n```text\n{}\n```", lines.join("\n"))), "{name}");
    }
}

#[test]
fn behaves_variants_repair_the_scene_that_they_start_from() {
    // Deeper than the ring is thick, but for what varies.
    let text = "(name: \"x\", set: [\"defect.depth_mm=9\"], variants: grid([(field: \"defect.depth_mm\", \
        values: [0.2])]))";
    assert!(parse(text).unwrap().runs[0].scene.is_ok());
}

/// Two bearings in two classes with eight points each: every combination has eight, sizes in shares of the spacing and
/// loads of the rating lie in their ranges, members are few, and a name stands for its number wherever it is written.
#[test]
fn by_hand_a_design_is_balanced_and_follows_the_bearing() {
    let text = "(name: \"b\", set: [\"defect=None\", \"film=None\", \"model=reduced()\"], variants: latin_hypercube(
        count: 8,
        each: [
            (field: \"bearing\", values: [\"6205\", \"NU 210\"]),
            (name: \"class\", cases: [
                (name: \"healthy\"),
                (name: \"outer\", set: [\"defects=[(on: outer, form: spall(length_mm: LENGTH_MM, edge: rectangular))]\"]),
            ]),
        ],
        members: [(
            name: \"machine\",
            count: 3,
            over: [(name: \"KG\", from: 5, to: 20)],
            set: [\"housing=machine(mass_kg: KG)\"],
        )],
        over: [
            (field: \"operation.load_n\", from: 0.01, to: 0.1, log: true, times: static_rating_n),
            (name: \"LENGTH_MM\", from: 0.01, to: 0.5, log: true, times: spacing_mm, least: 0.4),
        ],
    ))";
    let campaign = parse(text).unwrap();
    assert_eq!(campaign.fields, ["bearing", "class", "machine", "operation.load_n", "LENGTH_MM"]);
    assert_eq!(campaign.runs.len(), 32);
    let mut counts: BTreeMap<(String, String), usize> = BTreeMap::new();
    let mut masses: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for run in &campaign.runs {
        let [bearing, class, machine, load, length] = &run.values[..] else { panic!("{:?}", run.values) };
        *counts.entry((bearing.clone(), class.clone())).or_default() += 1;
        let scene = run.scene.as_ref().unwrap();
        let mass = scene.housing.machine().and_then(|machine| machine.mass_kg).unwrap();
        masses.entry(machine).or_default().push(mass);
        let (load, length): (f64, f64) = (load.parse().unwrap(), length.parse().unwrap());
        let share = load / scene.static_rating_n();
        assert!((0.0099..0.101).contains(&share) && scene.operation.load_n == load, "{share}");
        let spacing =
            std::f64::consts::PI * scene.bearing.inner_race_diameter_mm / scene.bearing.rollers as f64;
        assert!(length > 0.399 && length < 0.5 * spacing, "{length} of {spacing}");
        let spalls: Vec<f64> = scene.spalls().iter().map(|spall| spall.length_mm).collect();
        assert_eq!(spalls, if class == "outer" { vec![length] } else { vec![] });
    }
    assert!(counts.len() == 4 && counts.values().all(|count| *count == 8), "{counts:?}");
    assert!(masses.len() == 3 && masses.values().all(|of| of.iter().all(|kg| *kg == of[0])), "{masses:?}");
    // The first rows have some of every combination.
    let first: BTreeMap<_, ()> =
        campaign.runs[..4].iter().map(|run| (run.values[..2].to_vec(), ())).collect();
    assert_eq!(first.len(), 4);
}

#[test]
fn refuses_axes_that_are_no_list_and_no_range() {
    for (axis, words) in [
        ("(values: [1])", "an axis has a `field`, or a `name`"),
        ("(name: \"length\", from: 1, to: 2)", "in capital letters"),
        ("(name: \"class\", values: [1])", "takes either `cases"),
        ("(field: \"operation.load_n\", cases: [(name: \"a\")])", "takes either `values"),
        ("(field: \"operation.load_n\", name: \"A\", values: [1])", "either a field"),
    ] {
        let refused =
            parse(&format!("(name: \"x\", variants: sobol(count: 2, over: [{axis}]))")).unwrap_err();
        assert_has(&refused, &[words, "a.ron:1"]);
    }
}

#[test]
fn behaves_a_data_set_names_its_licence() {
    let with = |of: &str| {
        parse(&format!(
            "(name: \"x\", data_set: {of}, variants: grid([(field: \"operation.load_n\", values: [1000])]))"
        ))
    };
    let set = with("(title: \"t\", licence: \"CC-BY-4.0\", citation: \"c\")").unwrap().data_set.unwrap();
    assert_eq!((set.licence.as_str(), set.parts), ("CC-BY-4.0", 16));
    assert_has(&with("(title: \"t\")").unwrap_err(), &["licence"]);
}
