//! The page of a record with several bearings and gears.

use std::path::Path;

use maud::html;
use serde::Serialize;
use stribeck_diagnosis::sources::{Component, Sources};
use stribeck_diagnosis::{MeasuredFindings, quantities};
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::measured::write_measured;
use crate::page::{document, json as pretty};

quantities! {
    /// Content of `findings.json` of a record with several components.
    #[derive(Debug, Serialize)]
    pub struct SourcesFindings {
        /// Bearings and gears, as they were given.
        pub components: Vec<String>,
        /// The verdict on all of them.
        pub verdict: String,
        /// Each bearing.
        pub bearings: Vec<SourceFindings>,
    }
}

quantities! {
    /// A bearing of such a record.
    #[derive(Debug, Serialize)]
    pub struct SourceFindings {
        /// As it was given.
        pub component: String,
        /// Its speed over that of the shaft.
        pub ratio: f64,
        /// Folder of its own page, below that of the record.
        pub folder: String,
        /// Its findings.
        pub findings: MeasuredFindings,
    }
}

/// Writes `findings.json` and `report.html` of all components into `folder`, and below it the page of each
/// bearing.
pub fn write_sources(
    folder: &Path,
    file: &str,
    components: &[Component],
    sources: &Sources,
) -> Result<(), Error> {
    let mut bearings = Vec::new();
    for (n, (component, analysis)) in sources.bearings.iter().enumerate() {
        let own = subfolder(n, component);
        write_measured(&folder.join(&own), &format!("{file}: {component}"), analysis, None)?;
        bearings.push(SourceFindings {
            component: component.to_string(),
            ratio: component.ratio,
            folder: own,
            findings: analysis.findings.clone(),
        });
    }
    let words: Vec<String> = components.iter().map(ToString::to_string).collect();
    let all = SourcesFindings { components: words.clone(), verdict: sources.verdict.to_string(), bearings };
    write_atomic(&folder.join("findings.json"), pretty(&all)?.as_bytes())?;
    let title = format!("{file}: {} components", components.len());
    let page = document(
        &title,
        html! {
            h1 { (title) }
            p class="lead" { (words.join("; ")) "." }
            div class="scroll" { table {
                tr { th { "Bearing" } th { "Shaft (rpm)" } th { "Family" } th { "Measured (Hz)" } th { "Claimed" } th { "Why" } }
                @for (n, (component, analysis)) in sources.bearings.iter().enumerate() {
                    @for family in &analysis.findings.families {
                        tr {
                            td { a href=(format!("{}/report.html", subfolder(n, component))) { (component.to_string()) } }
                            td { (analysis.findings.speed_rpm.map_or_else(String::new, |rpm| format!("{rpm:.1}"))) }
                            td { (family.name.name()) }
                            td { (family.measured_hz.map_or_else(|| "–".to_owned(), |hz| format!("{hz:.2}"))) }
                            td { @if family.claimed { strong { "yes" } } @else { "no" } }
                            td { (family.reason.to_string()) }
                        }
                    }
                }
            } }
            @for (component, analysis) in &sources.bearings {
                p { strong { (component.to_string()) ": " } (analysis.findings.verdict) }
            }
        },
    );
    write_atomic(&folder.join("report.html"), page.into_string().as_bytes())?;
    Ok(())
}

/// Folder of a bearing below that of the record.
fn subfolder(n: usize, component: &Component) -> String {
    let name =
        component.bearing().map_or(String::new(), |b| b.name.replace(|c: char| !c.is_alphanumeric(), "-"));
    format!("{}-{name}", n + 1)
}
