//! The five likeliest mistakes with each command of the first hour, from an empty folder: each is answered by
//! a message that names what was wrong and what to try, the command fails, and nothing is left behind.

use std::fs;

use crate::common::Desk;
use stribeck_testing::said;

/// A line after the program's name, and words of the answer: the value as it was given, and the way out.
type Mistake = (&'static [&'static str], &'static [&'static str]);

/// Two runs that are not there, no run at all, one side, a scene in the place of a run, a folder.
const COMPARE: [Mistake; 5] = [
    (&["compare", "a", "b"], &["`a` is no file and no run", "`stribeck simulate` makes one"]),
    (&["compare"], &["<RUN_OR_FILE>", "Example: stribeck compare"]),
    (&["compare", "a"], &["2 values required", "only 1", "Example: stribeck compare"]),
    (&["compare", "mine.ron", "other.csv"], &["`mine.ron` is no file and no run", "is given by its file"]),
    (&["compare", ".", "."], &["`.` is a folder, and no run", "give the folder of a run"]),
];

/// One value, a misspelt field, a value out of range, a word for a number, no scene of that name.
const SWEEP: [Mistake; 5] = [
    (&["sweep", "--set=operation.load_n=1000"], &["no field has several values", "stribeck simulate"]),
    (
        &["sweep", "--set=operation.lod_n=1,2"],
        &["no field `operation.lod_n`", "did you mean `operation.load_n` [N]"],
    ),
    (&["sweep", "--set=operation.load_n=1000,-5"], &["is -5", "more than 0, at most 1e9 N"]),
    (&["sweep", "--set=operation.load_n=1000,much"], &["is `much`, which is not a number", "1e9 N"]),
    (&["sweep", "mine.ron", "--set=operation.load_n=1,2"], &["`mine.ron`", "no such file", "check the path"]),
];

/// A bearing that is not known, a negative load, an ending, a flag with underscores, a misspelt ring.
const NEW: [Mistake; 5] = [
    (&["new", "--bearing=62O5"], &["no bearing `62O5`", "did you mean `6205`", "stribeck bearings"]),
    (&["new", "--load-n=-5"], &["'-5'", "--load-n", "no number above 0"]),
    (&["new", "mine.txt"], &["`mine.txt`", "ends in `.ron`, such as `mine.ron`"]),
    (&["new", "--load_n=3000"], &["'--load_n'", "'--load-n'"]),
    (&["new", "--defect=ouder"], &["'ouder'", "outer, inner, roller, none"]),
];

/// A folder that is not there, a misspelt flag, two folders, two loudnesses, a file.
const LIST: [Mistake; 5] = [
    (&["list", "results"], &["no folder `results`", "without one lists `runs`"]),
    (&["list", "--jsn"], &["'--jsn'", "'--json'"]),
    (&["list", "runs", "more"], &["'more'", "stribeck list [OPTIONS] [FOLDER]"]),
    (&["list", "-q", "-v"], &["'--quiet' cannot be used with '--verbose'"]),
    (&["list", "mine.ron"], &["no folder `mine.ron`"]),
];

/// Nothing to open, a run that is not there, a page in the place of a run, a misspelt flag, a folder.
const OPEN: [Mistake; 5] = [
    (&["open"], &["nothing in `runs` has a page", "stribeck simulate"]),
    (&["open", "mine"], &["there is no `mine`", "no runs in `runs`", "stribeck simulate"]),
    (&["open", "report.html"], &["there is no `report.html`", "no runs in `runs`"]),
    (&["open", "--prnt"], &["'--prnt'", "'--print'"]),
    (&["open", ".."], &["`..` holds no run", "stribeck list"]),
];

/// No run named, a run that is not there, everything, the folder itself, a pattern that the shell left.
const RM: [Mistake; 5] = [
    (&["rm"], &["<RUN>", "Example: stribeck rm"]),
    (&["rm", "mine", "-y"], &["there is no `mine`", "Nothing was removed"]),
    (&["rm", "--all"], &["'--all'", "Example: stribeck rm"]),
    (&["rm", ".", "-y"], &["`.` holds no run", "Nothing was removed"]),
    (&["rm", "runs/*", "-y"], &["there is no `runs/*`", "Nothing was removed"]),
];

/// No scene of that name, a misspelt field, a value out of range, no value, a flag of another command.
const PLAN: [Mistake; 5] = [
    (&["plan", "mine.ron"], &["`mine.ron`", "no such file", "check the path"]),
    (&["plan", "--set=mesh.sice_mm=1"], &["no field `mesh.sice_mm`", "did you mean `mesh.size_mm`"]),
    (&["plan", "--set=mesh.size_mm=0"], &["is 0", "more than 0, at most 1000 mm"]),
    (&["plan", "--set=mesh.size_mm"], &["`mesh.size_mm` has no `=`", "--set mesh.size_mm=1.0"]),
    (&["plan", "--threads=4"], &["'--threads'", "Example: stribeck plan"]),
];

/// No shell, a misspelt one, one that is not known, two, a flag.
const COMPLETIONS: [Mistake; 5] = [
    (&["completions"], &["<SHELL>", "Example: stribeck completions bash"]),
    (&["completions", "bsh"], &["'bsh'", "bash, elvish, fish, powershell, zsh", "'bash'"]),
    (&["completions", "tcsh"], &["'tcsh'", "bash, elvish, fish, powershell, zsh"]),
    (&["completions", "bash", "zsh"], &["'zsh'", "Example: stribeck completions bash"]),
    (&["completions", "--bash"], &["'--bash'", "Example: stribeck completions bash"]),
];

/// No run yet, a run that is not there, a rate of no sound card, slower than a sound can be, another format.
const EXPORT: [Mistake; 5] = [
    (&["export", "--to=wav"], &["no runs in `runs`", "stribeck simulate"]),
    (&["export", "mine", "--to=wav"], &["there is no `mine`", "stribeck simulate"]),
    (&["export", "mine", "--to=wav", "--rate-hz=8000"], &["'8000'", "--rate-hz", "44100 or 48000"]),
    (&["export", "mine", "--to=wav", "--slow=0"], &["'0'", "--slow", "1 to 1000 times slower"]),
    (&["export", "mine", "--to=mp3"], &["'mp3'", "wav", "Example: stribeck export"]),
];

/// A letter for a digit, no comma, a number that is none, one out of range, a kind that no plane model has.
const BEARINGS: [Mistake; 5] = [
    (&["bearings", "62O5"], &["no bearing `62O5`", "did you mean `6205`"]),
    (&["bearings", "NU 205 elements=13"], &["`NU 205 elements`", "a comma parts a name"]),
    (&["bearings", "NU 205, elements=many"], &["`many` of the bearing is no number"]),
    (&["bearings", "NU 205, elements=1"], &["3 to 200 rolling elements, not 1"]),
    (&["bearings", "51105"], &["`51105` is a thrust bearing", "no radial load"]),
];

#[test]
fn refuses_the_likeliest_mistakes_with_the_way_out() {
    let all = [COMPARE, SWEEP, NEW, LIST, OPEN, RM, PLAN, COMPLETIONS, EXPORT, BEARINGS];
    let desk = Desk::new("mistakes");
    let mut wrong = Vec::new();
    for (words, told) in all.iter().flatten() {
        let output = desk.run(*words);
        let answer = said(&output);
        let missing: Vec<_> = told.iter().filter(|part| !answer.contains(**part)).collect();
        // 1 where a command refuses, 2 for a command line that cannot be parsed.
        if !matches!(output.status.code(), Some(1 | 2)) || !missing.is_empty() || answer.contains("panicked")
        {
            wrong.push(format!("stribeck {}\n{answer}lacks {missing:?}", words.join(" ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let left = fs::read_dir(desk.path()).expect("readable").count();
    assert_eq!(left, 0, "a refused command left something");
}
