//! All frames of a run in one VTKHDF file: an unstructured grid that changes from step to step, in version
//! 2.2 of the format.
//!
//! Every offset that a reader may request is written, those of the fields too: ParaView crashes without them.

use std::path::Path;

use anyhow::{Context, Result};
use hdf5_pure::{AttrValue, FileBuilder};

use super::Stressed;

/// Kinds of cells.
const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

pub(super) fn write(path: &Path, frames: &[Stressed], notes: &[String]) -> Result<()> {
    let steps = frames.len() as u64;
    let (mut points, mut displacement) = (Vec::new(), Vec::new());
    let (mut connectivity, mut offsets, mut kinds, mut stress) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    // Of each step: points, cells and corners, and how many came before.
    let (mut counts, mut before) = ([const { Vec::new() }; 3], [const { Vec::new() }; 3]);
    for frame in frames {
        let mesh = &frame.part.mesh;
        for (n, so_far) in [points.len() / 3, kinds.len(), connectivity.len()].into_iter().enumerate() {
            before[n].push(so_far as i64);
        }
        let first = connectivity.len();
        points.extend(mesh.x.iter().zip(&mesh.y).flat_map(|(x, y)| [*x, *y, 0.0]));
        displacement.extend(frame.part.displacement.iter().flat_map(|u| [u[0], u[1], 0.0]));
        offsets.push(0);
        for corners in frame.part.elements() {
            connectivity.extend(corners.iter().map(|n| i64::from(*n)));
            offsets.push((connectivity.len() - first) as i64);
            kinds.push(if corners.len() == 3 { TRIANGLE } else { QUAD });
        }
        stress.extend(&frame.stress);
        for (n, now) in [points.len() / 3, kinds.len(), connectivity.len()].into_iter().enumerate() {
            counts[n].push(now as i64 - before[n][before[n].len() - 1]);
        }
    }
    let times: Vec<f64> = frames.iter().map(|frame| frame.time_s).collect();
    let mut file = FileBuilder::new();
    let mut root = file.create_group("VTKHDF");
    root.set_attr("Version", AttrValue::I64Array(vec![2, 2]));
    root.set_attr("Type", AttrValue::AsciiString("UnstructuredGrid".into()));
    let vectors = |data: &[f64]| [data.len() as u64 / 3, 3];
    root.create_dataset("Points").with_f64_data(&points).with_shape(&vectors(&points));
    root.create_dataset("Connectivity").with_i64_data(&connectivity);
    root.create_dataset("Offsets").with_i64_data(&offsets);
    root.create_dataset("Types").with_u8_data(&kinds);
    for (name, of) in ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"].into_iter().zip(&counts)
    {
        root.create_dataset(name).with_i64_data(of);
    }
    let mut group = root.create_group("PointData");
    group.create_dataset("displacement_m").with_f64_data(&displacement).with_shape(&vectors(&displacement));
    root.add_group(group.finish());
    let mut group = root.create_group("CellData");
    group.create_dataset("von_mises_pa").with_f64_data(&stress);
    root.add_group(group.finish());
    let mut time = root.create_group("Steps");
    time.set_attr("NSteps", AttrValue::I64(steps as i64));
    time.create_dataset("Values").with_f64_data(&times);
    time.create_dataset("PartOffsets").with_i64_data(&(0..steps as i64).collect::<Vec<_>>());
    time.create_dataset("NumberOfParts").with_i64_data(&vec![1; frames.len()]);
    time.create_dataset("PointOffsets").with_i64_data(&before[0]);
    time.create_dataset("CellOffsets").with_i64_data(&before[1]).with_shape(&[steps, 1]);
    time.create_dataset("ConnectivityIdOffsets").with_i64_data(&before[2]).with_shape(&[steps, 1]);
    for (group, field, of) in
        [("PointDataOffsets", "displacement_m", &before[0]), ("CellDataOffsets", "von_mises_pa", &before[1])]
    {
        let mut offsets = time.create_group(group);
        offsets.create_dataset(field).with_i64_data(of);
        time.add_group(offsets.finish());
    }
    root.add_group(time.finish());
    file.add_group(root.finish());
    // Outside the group that readers understand; unknown groups are ignored.
    file.set_attr("notes", AttrValue::String(notes.join("\n")));
    file.write(path).with_context(|| format!("cannot write `{}`", path.display()))?;
    Ok(())
}
