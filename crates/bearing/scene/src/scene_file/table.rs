//! Profiles from CSV files, and meshes of housings and rings: reading inserts their content, so that a run
//! holds its complete scene.
//!
//! ```text
//! time_ms, value
//! 0,       500
//! 100,     1500
//! ```
//!
//! The first line names the columns, of which two are read: `time_ms` and `value` of a speed or a load,
//! `position_mm` and `depth_um` of a surface. Text after `#` is a comment.

use std::path::Path;

use super::{INNER_RING_MESH, LOAD_PROFILE, OUTER_RING_MESH, OUTER_SPEED_PROFILE, SPEED_PROFILE};
use crate::deviation::{FormScene, PointScene};
use crate::field::wording::{number, shown};
use crate::housing::HousingScene;
use crate::machine::MachineScene;
use crate::mesh_text;
use crate::mesh_text::bytes_of;
use crate::reading::problem::{Problem, SceneError, place_in_file};
use crate::reading::ranges;
use crate::reading::sources::{Kind, Sources};
use crate::scene::{ProfileScene, Scene};

/// Longest table [bytes].
const MAX_BYTES: u64 = 1 << 20;
/// Largest mesh of a body [bytes]: some fifty thousand elements. The scene of the run holds it.
const MAX_MESH_BYTES: u64 = 4 << 20;
/// Most rows: the scene of the run holds them all.
const MAX_ROWS: usize = 10_000;
/// Purpose of a table.
struct Table<'a> {
    /// The field that takes it.
    path: &'a str,
    /// Its columns, the ascending one first.
    columns: [&'static str; 2],
    /// Returns the range where a value is outside.
    refuses: &'a dyn Fn(f64) -> Option<String>,
}

/// Puts the points of tables in their place; `folder` is where their paths count from.
pub(crate) fn read(scene: &mut Scene, folder: &Path, sources: &Sources) -> Result<(), SceneError> {
    let o = &mut scene.operation;
    for (path, profile) in [
        (SPEED_PROFILE, &mut o.speed_profile),
        (OUTER_SPEED_PROFILE, &mut o.outer_speed_profile),
        (LOAD_PROFILE, &mut o.load_profile),
    ] {
        let Some(ProfileScene::Table(name)) = profile else { continue };
        let refuses = |value: f64| ranges::refuses(path, value);
        let table = Table { path, columns: ["time_ms", "value"], refuses: &refuses };
        *profile = Some(ProfileScene::Points(table.read(folder, name, sources)?));
    }
    if let HousingScene::Mesh(housing) = &mut scene.housing {
        read_mesh("housing", &housing.file, &mut housing.text, folder, sources)?;
    }
    if let HousingScene::Machine(machine) = &mut scene.housing
        && !machine.file.is_empty()
    {
        read_machine(machine, folder, sources)?;
        scene.sample_for_machine();
    }
    for (path, mesh) in
        [(OUTER_RING_MESH, &mut scene.outer_ring_mesh), (INNER_RING_MESH, &mut scene.inner_ring_mesh)]
    {
        if let Some(mesh) = mesh {
            read_mesh(path, &mesh.file, &mut mesh.text, folder, sources)?;
        }
    }
    for (i, deviation) in scene.defects.iter_mut().enumerate() {
        let FormScene::Profile(profile) = &mut deviation.form else { continue };
        // The scene of a run holds the points.
        if profile.file.is_empty() || !profile.points.is_empty() {
            continue;
        }
        let path = format!("defects[{i}].form.file");
        let table = Table { path: &path, columns: ["position_mm", "depth_um"], refuses: &|_| None };
        let points = table.read(folder, &profile.file, sources)?;
        profile.points = points.into_iter().map(|(at_mm, depth_um)| PointScene { at_mm, depth_um }).collect();
    }
    Ok(())
}

/// Completes a machine by its file, which the scene of a run does not need any more.
fn read_machine(machine: &mut MachineScene, folder: &Path, sources: &Sources) -> Result<(), SceneError> {
    let file = folder.join(&machine.file);
    if !file.is_file() {
        let field = "housing.file";
        let message = format!("cannot read the machine `{}`: there is no such file", shown(&machine.file));
        let mut problem = Problem::new(message, sources.place(field));
        field.clone_into(&mut problem.field);
        "a file that `stribeck machine` wrote".clone_into(&mut problem.allowed);
        "check the path, which counts from the folder of the scene".clone_into(&mut problem.suggestion);
        return Err(problem.into());
    }
    *machine = std::mem::take(machine).before(MachineScene::read(&file)?);
    Ok(())
}

impl Scene {
    /// Samples at least as often as the sensor of its machine, which a file has brought.
    pub fn sample_for_machine(&mut self) {
        let Some(machine) = self.housing.machine() else { return };
        let rate_hz = machine.sensor.rate_hz;
        if 1e6 / self.output.interval_us < rate_hz {
            let interval_us = 1e6 / rate_hz;
            self.output.interval_us =
                if 1e6 / interval_us < rate_hz { interval_us.next_down() } else { interval_us };
        }
    }
}

/// The file of a machine.
const FILE: Kind = Kind {
    noun: "a machine",
    example: "`(mass_kg: 10, sensor: (rate_hz: 25600))`",
    for_fields_of_scenes: Some(""),
};

impl MachineScene {
    /// Reads the machine in a file.
    ///
    /// # Errors
    /// When it cannot be read, or is no machine.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let text = crate::reading::load::load(path)?;
        let (machine, _) = super::read_as(super::without_mark(&text), &path.display().to_string(), &FILE)?;
        Ok(machine)
    }
}

/// Inserts the content of the mesh `file` of the group `path` into `text`, unless it is there.
fn read_mesh(
    path: &str,
    file: &str,
    text: &mut String,
    folder: &Path,
    sources: &Sources,
) -> Result<(), SceneError> {
    if !text.is_empty() {
        return Ok(());
    }
    let refuse = |why: &str, instead: &str| {
        let field = format!("{path}.file");
        let mut problem =
            Problem::new(format!("cannot read the mesh `{}`: {why}", shown(file)), sources.place(&field));
        problem.field = field;
        "a Gmsh (`.msh`) or Abaqus (`.inp`) file".clone_into(&mut problem.allowed);
        instead.clone_into(&mut problem.suggestion);
        problem
    };
    if let Some([why, instead]) = mesh_text::refused_by_name(file) {
        return Err(refuse(why, instead).into());
    }
    *text = mesh_text::read(&folder.join(file), MAX_MESH_BYTES)
        .map_err(|why| refuse(&why, "check the path, which counts from the folder of the scene"))?;
    Ok(())
}

impl Table<'_> {
    /// Its points, from the file of that name; `folder` is where its path counts from.
    fn read(&self, folder: &Path, name: &str, sources: &Sources) -> Result<Vec<(f64, f64)>, SceneError> {
        let file = folder.join(name);
        let bytes = bytes_of(&file, MAX_BYTES);
        let utf8 = |bytes| String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".to_owned());
        let text = bytes.and_then(utf8).map_err(|why| {
            let place = sources.place(self.path);
            let mut problem = Problem::new(format!("cannot read the table `{}`: {why}", shown(name)), place);
            self.path.clone_into(&mut problem.field);
            problem.allowed = self.form();
            "check the path, which counts from the folder of the scene".clone_into(&mut problem.suggestion);
            problem
        })?;
        let points = self.points(&text).map_err(|fault| {
            let place = place_in_file(&file.display().to_string(), &text, fault.range);
            let mut problem = Problem::new(fault.message, place);
            self.path.clone_into(&mut problem.field);
            problem.allowed = fault.allowed;
            problem
        })?;
        Ok(points)
    }

    /// Its form.
    fn form(&self) -> String {
        let [first, second] = self.columns;
        format!("a CSV file whose first line is `{first},{second}`, with two numbers in each line")
    }

    /// Its rows.
    fn points(&self, text: &str) -> Result<Vec<(f64, f64)>, Fault> {
        let [first, second] = self.columns;
        let fault =
            |range, message: String, allowed: &str| Fault { range, message, allowed: allowed.to_owned() };
        let mut columns: Option<([usize; 2], usize)> = None;
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let (begin, end) = (start, start + line.len());
            start = end;
            let cells: Vec<(usize, &str)> = cells(line, begin);
            if cells.iter().all(|(_, cell)| cell.is_empty()) {
                continue;
            }
            let Some((which, named)) = columns else {
                let find = |name: &str| {
                    let at = cells.iter().position(|(_, cell)| *cell == name);
                    at.ok_or_else(|| {
                        fault(begin..end, format!("the table has no column `{name}`"), &self.form())
                    })
                };
                columns = Some(([find(first)?, find(second)?], cells.len()));
                continue;
            };
            // As from a decimal comma, `0,5`: the digits after it would be taken for another number.
            if let Some((at, cell)) = cells.iter().skip(named).find(|(_, cell)| !cell.is_empty()) {
                let message =
                    format!("the row has {} columns, and the first line names {named}", cells.len());
                let allowed = format!("{}, each with a decimal point", self.form());
                return Err(fault(*at..at + cell.len(), message, &allowed));
            }
            if points.len() == MAX_ROWS {
                let message = format!("the table has more than {MAX_ROWS} rows");
                return Err(fault(begin..end, message, "fewer points: lines run between them"));
            }
            let read = |column: usize, name: &str| {
                let Some((at, cell)) = cells.get(column) else {
                    return Err(fault(begin..end, format!("the row has no `{name}`"), &self.form()));
                };
                let range = *at..at + cell.len().max(1);
                match cell.parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok((value, range)),
                    _ => Err(fault(
                        range,
                        format!("`{name}` is `{}`, which is not a number", shown(cell)),
                        &self.form(),
                    )),
                }
            };
            let ((time, at_time), (value, at_value)) = (read(which[0], first)?, read(which[1], second)?);
            if let Some((before, _)) = points.last().filter(|(before, _)| time <= *before) {
                let message =
                    format!("`{first}` is {}, not after {} of the row before", number(time), number(*before));
                return Err(fault(at_time, message, "rows that ascend"));
            }
            if let Some(allowed) = (self.refuses)(value) {
                let message =
                    format!("`{second}` is {}, outside the range of `{}`", number(value), self.path);
                return Err(fault(at_value, message, &allowed));
            }
            points.push((time, value));
        }
        if points.is_empty() {
            return Err(fault(0..text.len(), "the table has no rows".to_owned(), &self.form()));
        }
        Ok(points)
    }
}

/// An error of a table, with its place.
struct Fault {
    range: std::ops::Range<usize>,
    message: String,
    allowed: String,
}

/// Cells of a line without their blanks, and where they begin in the text; `from` is where the line does.
fn cells(line: &str, from: usize) -> Vec<(usize, &str)> {
    let line = line.split('#').next().unwrap_or_default();
    let mut at = from;
    line.split(',')
        .map(|cell| {
            // Some editors write a byte order mark first.
            let text = cell.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
            let begin = at + cell.len() - text.len();
            at += cell.len() + 1;
            (begin, text.trim_end())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use stribeck_testing::Scratch;

    use super::*;

    fn scene(table: &str) -> Result<Scene, String> {
        let folder = Scratch::create("tables");
        let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("writable");
        write("speed.csv", table);
        write("x.ron", "(operation: (\n  speed_profile: table(\"speed.csv\"),\n))");
        Scene::read(folder.join("x.ron")).map_err(|e| e.to_string())
    }

    #[test]
    fn roundtrip_a_table_is_its_points_from_then_on() {
        let scene =
            scene("\u{feff}# by hand\nvalue, time_ms , note\r\n500,0,first\n\n750.5 , 20 # half\n-10,30")
                .unwrap();
        let points = vec![(0.0, 500.0), (20.0, 750.5), (30.0, -10.0)];
        assert_eq!(scene.operation.speed_profile, Some(ProfileScene::Points(points)));
        assert_eq!(Scene::parse(&scene.to_ron(), "again").unwrap(), scene);
    }

    #[test]
    fn refuses_tables_with_file_line_and_value() {
        for (table, words) in [
            ("", "has no rows"),
            ("time_ms,value\n", "has no rows"),
            ("0,500\n", "speed.csv:1:1"),
            ("0,500\n", "no column `time_ms`"),
            ("time_ms,speed\n0,1\n", "no column `value`"),
            ("time_ms,value\n0,500\n5,fast\n", "speed.csv:3:3"),
            ("time_ms,value\n0,500\n5,fast\n", "`value` is `fast`"),
            ("time_ms,value\n0,500\n5\n", "the row has no `value`"),
            ("time_ms,value\n0,500\n0,600\n", "`time_ms` is 0, not after 0"),
            ("time_ms,value\n0,1e9\n", "-100000 to 100000 rpm"),
            ("time_ms,value\n0,NaN\n", "is `NaN`"),
            ("time_ms,value\n0,1500,5\n", "speed.csv:2:8"),
            ("time_ms,value\n0,1500,5\n", "has 3 columns, and the first line names 2"),
        ] {
            let said = scene(table).expect_err(table);
            assert!(said.contains(words) && !said.contains("x.ron"), "{table}: {said}");
        }
        let long: String = (0..=MAX_ROWS).map(|n| format!("{n},1\n")).collect();
        assert!(
            scene(&format!("time_ms,value\n{long}")).expect_err("too long").contains("more than 10000 rows")
        );
        let none = Scene::default().with_overrides(&["operation.load_profile=table(\"no.csv\")"]);
        let said = none.expect_err("no file").to_string();
        assert!(
            said.contains("cannot read the table `no.csv`") && said.contains("--set operation"),
            "{said}"
        );
    }

    #[test]
    fn behaves_the_profile_of_a_surface_from_a_table() {
        let folder = Scratch::create("surface-tables");
        let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("writable");
        write("pit.csv", "position_mm,depth_um\n-2,0\n0.5,40\n2,0\n");
        write("x.ron", "(film: None, defect: None, defects: [(form: profile(file: \"pit.csv\"))])");
        let scene = Scene::read(folder.join("x.ron")).unwrap();
        let FormScene::Profile(profile) = &scene.defects[0].form else { panic!("{:?}", scene.defects) };
        assert_eq!(profile.points[1], PointScene { at_mm: 0.5, depth_um: 40.0 });
        assert_eq!(Scene::parse(&scene.to_ron(), "again").unwrap(), scene);
        write("pit.csv", "position_mm,depth_um\n-2,0\n0.5,deep\n");
        let said = Scene::read(folder.join("x.ron")).expect_err("a word").to_string();
        assert!(said.contains("pit.csv:3:5") && said.contains("`depth_um` is `deep`"), "{said}");
        write("x.ron", "(film: None, defects: [(form: profile(file: \"none.csv\"))])");
        let said = Scene::read(folder.join("x.ron")).expect_err("no file").to_string();
        assert!(said.contains("none.csv") && said.contains("x.ron:1:"), "{said}");
    }

    #[test]
    fn roundtrip_the_longest_table_is_a_scene_that_can_be_read_again() {
        let rows: String = (0..MAX_ROWS)
            .map(|n| format!("{},{}\n", 0.1 + n as f64 / 3.0, 100.0 + 1.0 / (n + 1) as f64))
            .collect();
        let scene = scene(&format!("time_ms,value\n{rows}")).unwrap();
        let folder = Scratch::create("long-table");
        std::fs::write(folder.join("scene.ron"), scene.to_ron()).unwrap();
        assert_eq!(Scene::read(folder.join("scene.ron")).unwrap(), scene);
    }
}
