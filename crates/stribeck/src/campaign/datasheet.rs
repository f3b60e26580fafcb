//! What a data set is, in a page: made from its tables, beside them.

use std::collections::BTreeMap;

use stribeck_scene::campaign::Campaign;
use stribeck_scene::run_dir::Keep;

use super::tables::{RUNS, Row, SIGNALS};

/// The page in Markdown.
pub(super) fn text(campaign: &Campaign, rows: &[Row], columns: &[String]) -> String {
    let counted = |of: &dyn Fn(&Row) -> &'static str| {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        rows.iter().for_each(|row| *counts.entry(of(row)).or_default() += 1);
        counts.into_iter().map(|(name, count)| format!("{name} {count}")).collect::<Vec<_>>().join(", ")
    };
    let mut page = format!(
        "# Data set `{}`\n\n\
         Simulated by Stribeck {}; nothing in it was measured. Each run is a folder below `runs/`, named by the hash of its scene, \
         with its complete scene, provenance{}.\n\n\
         | | |\n|---|---|\n| runs | {} |\n| ended as | {} |\n| split | {} |\n| seed | {} |\n\n",
        campaign.name,
        env!("CARGO_PKG_VERSION"),
        match campaign.keep {
            Keep::All => ", sampled channels and energy ledger",
            Keep::Signals => ", numbers and the channels of its sensors",
            Keep::Numbers => " and numbers",
        },
        rows.len(),
        counted(&|row| row.status),
        counted(&|row| row.split),
        campaign.seed
    );
    let signals = match campaign.keep {
        Keep::All | Keep::Signals => format!(
            "`{SIGNALS}` has a row for each sample of the accelerations, a group of rows a run; `run` joins them. "
        ),
        Keep::Numbers => String::new(),
    };
    page += &format!(
        "`{RUNS}` has a row for each run, also for those that failed: `status` and `reason` say why. {signals}The split is drawn by the values of a variant, so no \
         scene and no start of it stands in two parts.\n\n\
         Ground truth: `fault_location`, `fault_size_mm`, `shaft_speed_rpm`, `load_n`; `bpfo_hz`, `bpfi_hz`, `bsf_hz` and `ftf_hz` are \
         kinematic, without slip. `scene.*` are the fields that vary, `summary.*` what the analysis of each run found (docs/THEORY.md, \
         §7, says how). What depends on machine or interruptions is only in the folders of the runs.\n\n\
         ## Limits\n\nA plane model with a defect of straight edges; rings of steel; one load zone. Peaks above some kilohertz differ between \
         starts of one scene by tens of per cent: learn from distributions, not from single records.\n\n## Columns of the runs\n\n"
    );
    for column in columns {
        page += &format!("- `{column}`\n");
    }
    page += &format!("\n## The campaign\n\n```ron\n{}\n```\n", campaign.text.trim_end());
    page
}
