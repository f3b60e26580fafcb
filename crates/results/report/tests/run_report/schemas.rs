//! What is written is what the schemas for other programs say.

use serde_json::Value;
use stribeck_diagnosis::record::alarm::{Limit, Quantity};
use stribeck_diagnosis::series::Series;
use stribeck_diagnosis::{Analysis, Machine, sources};
use stribeck_dsp::channel::Channel;
use stribeck_report::{self as report, SeriesFindings, SeriesRecord};
use stribeck_testing::Noise;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::read;
use stribeck_testing::Scratch;

/// Whether a value is what a schema allows; the first place where it is not.
pub(crate) fn agree(schema: &Value, value: &Value, path: &str) -> Result<(), String> {
    if let Some(kinds) = schema["anyOf"].as_array() {
        let refused: Vec<String> = kinds.iter().filter_map(|kind| agree(kind, value, path).err()).collect();
        return if refused.len() < kinds.len() { Ok(()) } else { Err(refused.join("; ")) };
    }
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if !number.is_f64() && schema["type"] == "integer" => "integer",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let allowed = &schema["type"];
    let is_allowed = allowed == kind || allowed.as_array().is_some_and(|all| all.iter().any(|a| a == kind));
    if !is_allowed {
        return Err(format!("{path} is {kind}, not {allowed}"));
    }
    for (name, inner) in value.as_object().into_iter().flatten() {
        let path = format!("{path}.{name}");
        agree(schema["properties"].get(name).ok_or(format!("{path} is declared nowhere"))?, inner, &path)?;
    }
    for name in schema["required"].as_array().into_iter().flatten() {
        value.get(name.as_str().unwrap_or_default()).ok_or(format!("{path}.{name} is missing"))?;
    }
    let items = value.as_array().map_or(&[][..], Vec::as_slice);
    if schema["minItems"].as_u64().is_some_and(|n| n != items.len() as u64) {
        return Err(format!("{path} has {} items", items.len()));
    }
    let each = |k: usize| schema["prefixItems"].get(k).unwrap_or(&schema["items"]);
    items.iter().enumerate().try_for_each(|(k, item)| agree(each(k), item, &format!("{path}[{k}]")))
}

/// An outer raceway of a 6205 that strikes at 1200 rpm, or a channel that is clipped at half of its peak.
fn record(rail: f64) -> Channel {
    let mut noise = Noise::new(7);
    let samples = (0..65_536).map(|n| {
        let since = (f64::from(n) / 12_800.0).rem_euclid(1.0 / 71.7);
        let impact = (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin();
        (noise.uniform() + 2.0 * impact).clamp(-rail, rail)
    });
    Channel::held("housing", samples.collect()).in_unit(Some("g".to_owned()))
}

/// A record, a series whose second record is clipped and whose third is missing, and two bearings and a gear.
#[test]
fn roundtrip_findings_follow_their_schema() {
    let folder = Scratch::new("schema");
    let of = |name: &str| folder.join(name);
    let machine = Machine {
        speed_rpm: Some(1200.0),
        bearing: Some(CatalogueBearing::parse("6205").expect("known")),
        ..Machine::default()
    };
    let analysed = |rail: f64| Analysis::of(&record(rail), 12_800.0, &machine).expect("a signal");
    report::write_measured(&of("one"), "a.mat", &analysed(f64::MAX), None).expect("written");

    let limits = [Limit { quantity: Quantity::Rms, warning: 0.1, alarm: 1.0 }];
    let found = [analysed(f64::MAX), analysed(0.8)].map(|analysis| Some(analysis.findings));
    let series = Series::of(&[found[0].as_ref(), found[1].as_ref(), None], 0, &[]);
    let records = found.into_iter().chain([None]).map(|findings| SeriesRecord {
        file: "a.mat".to_owned(),
        folder: None,
        alarms: findings.iter().filter_map(|found| limits[0].judge(found)).collect(),
        error: findings.is_none().then(|| "missing".to_owned()),
        findings,
    });
    let all = SeriesFindings { series, records: records.collect() };
    std::fs::create_dir(of("series")).expect("made");
    report::write_series(&of("series"), &all, &limits).expect("written");

    let components = ["bearing=6205", "bearing=NU 205, elements=13, ratio=2.5", "gear=23"];
    let bearing = |name: &str| CatalogueBearing::parse(name).map_err(|why| why.to_string());
    let components = components.map(|text| sources::Component::parse(text, bearing).expect("known"));
    let sources = sources::analyse(&record(f64::MAX), 12_800.0, &machine, &components).expect("a signal");
    report::write_sources(&of("several"), "a.mat", &components, &sources).expect("written");

    let schema = report::findings_schema();
    for (name, inside) in
        [("one", ""), ("series", "/records/1/findings"), ("several", "/bearings/0/findings")]
    {
        let json: Value = serde_json::from_str(&read(&of(name), "findings.json")).expect("JSON");
        agree(&schema, &json, name).expect("the schema allows it");
        let quality = json.pointer(&format!("{inside}/quality")).and_then(Value::as_array).expect("a list");
        assert_eq!(quality.is_empty(), name != "series", "{quality:?}");
        for (place, wrong) in [("samples", Value::from(0.5)), ("verdict", Value::Null)] {
            let mut json = json.clone();
            *json.pointer_mut(&format!("{inside}/{place}")).expect("there") = wrong;
            agree(&schema, &json, name).expect_err(place);
        }
    }
}
