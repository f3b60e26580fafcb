//! The page of several channels of one machine that were recorded together.

use std::path::Path;

use maud::{Markup, html};
use stribeck_diagnosis::joint::Joint;
use stribeck_diagnosis::words::numbers::chance;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{document, json};
use crate::series::{SeriesRecord, table};

/// Writes `joint.json` and `joint.html` of several channels of one machine and their joint verdict into
/// `folder`, which must be there.
pub fn write_joint(folder: &Path, joint: &Joint, entries: &[SeriesRecord]) -> Result<(), Error> {
    write_atomic(&folder.join("joint.json"), json(&joint)?.as_bytes())?;
    write_atomic(&folder.join("joint.html"), joint_page(joint, entries).into_string().as_bytes())?;
    Ok(())
}

fn joint_page(joint: &Joint, entries: &[SeriesRecord]) -> Markup {
    let title = format!("{} channels together", entries.len());
    document(
        &title,
        html! {
            h1 { (title) }
            p class="headline" { (joint.verdict) }
            @for note in &joint.notes { p class="hint" { (note) } }
            h2 #shares { "Share of each channel" }
            div class="scroll" { (families_by_channel(joint)) }
            p class="hint" {
                "The part of each channel in the power that swings with a family, and the height of the \
                family in it; bold where the channel claims a defect by itself. The probability of a false \
                alarm is the smallest of all channels times their number, which holds however they depend \
                on each other."
            }
            h2 #channels { "Channels" }
            div class="scroll" { (table(entries)) }
        },
    )
}

/// Families of a joint verdict: a row a family, a column a channel.
fn families_by_channel(joint: &Joint) -> Markup {
    let number = |x: Option<f64>, unit: &str, factor: f64| {
        x.map_or_else(|| "–".to_owned(), |x| format!("{:.0} {unit}", factor * x))
    };
    html! {
        table {
            tr {
                th { "Family" } @for name in &joint.channels { th { (name) } }
                th { "False alarm" } th { "Nearest" } th { "Verdict" }
            }
            @for family in &joint.families {
                tr {
                    td { (family.name) }
                    @for channel in &family.channels {
                        @let share = number(channel.share, "%", 100.0);
                        @let text = format!("{share}, {}", number(channel.height_db, "dB", 1.0));
                        td { @if channel.claimed { strong { (text) } } @else { (text) } }
                    }
                    td { (chance(family.p_value)) }
                    td { (family.nearest.as_deref().filter(|_| family.claimed).unwrap_or("–")) }
                    td { @if family.claimed { strong { "a defect" } } @else { "none" } }
                }
            }
        }
    }
}
