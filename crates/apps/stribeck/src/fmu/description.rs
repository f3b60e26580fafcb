//! `modelDescription.xml` of an FMU (FMI 3.0, §2.4): its variables, with units and causality.

use std::fmt::Write;

use stribeck_reduced::shaft::OnShaft;
use stribeck_reduced::shaft::variables::{BEFORE_SENSORS, INPUTS, OUTPUTS, SENSORS, TOKEN, Variable};
use stribeck_scene::scene::Scene;

use super::IDENTIFIER;

/// Units of the variables, by base units of SI.
const UNITS: [(&str, &str); 6] = [
    ("s", "s=\"1\""),
    ("m", "m=\"1\""),
    ("m/s", "m=\"1\" s=\"-1\""),
    ("m/s2", "m=\"1\" s=\"-2\""),
    ("N", "kg=\"1\" m=\"1\" s=\"-2\""),
    ("rad", "rad=\"1\""),
];

/// The description of a scene's bearing.
pub(super) fn xml(scene: &Scene, bearing: &OnShaft) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut line = |words: std::fmt::Arguments<'_>| {
        // Writing into a text cannot fail.
        writeln!(text, "{words}").unwrap_or_default();
    };
    let designation = &scene.bearing.designation;
    let bearing_name = if designation.is_empty() { "A bearing".to_owned() } else { escaped(designation) };
    line(format_args!(
        "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{}\" instantiationToken=\"{TOKEN}\"\n    \
         description=\"{bearing_name}: shaft displacement in, force of the bearing on the shaft out\"\n    \
         generationTool=\"Stribeck {}\" variableNamingConvention=\"flat\">",
        escaped(&scene.name),
        env!("CARGO_PKG_VERSION"),
    ));
    line(format_args!(
        "  <CoSimulation modelIdentifier=\"{IDENTIFIER}\" canHandleVariableCommunicationStepSize=\"true\"/>"
    ));
    line(format_args!("  <UnitDefinitions>"));
    for (name, base) in UNITS {
        line(format_args!("    <Unit name=\"{name}\"><BaseUnit {base}/></Unit>"));
    }
    line(format_args!("  </UnitDefinitions>"));
    line(format_args!(
        "  <DefaultExperiment startTime=\"0\" stopTime=\"{}\" stepSize=\"{}\"/>",
        1e-3 * scene.solver.duration_ms,
        (20e-6_f64).max(10.0 * bearing.time_step)
    ));
    line(format_args!("  <ModelVariables>"));
    line(format_args!(
        "    <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" \
         variability=\"continuous\" unit=\"s\"/>"
    ));
    let outputs = outputs(scene);
    for (reference, variable) in (1..).zip(INPUTS) {
        line(format_args!("{}", float(reference, &variable, "causality=\"input\" start=\"0\"", None)));
    }
    for (reference, variable, sensor) in &outputs {
        let causality = "causality=\"output\" initial=\"calculated\"";
        line(format_args!("{}", float(*reference, variable, causality, sensor.as_deref())));
    }
    line(format_args!("  </ModelVariables>\n  <ModelStructure>"));
    for kind in ["Output", "InitialUnknown"] {
        for (reference, ..) in &outputs {
            line(format_args!("    <{kind} valueReference=\"{reference}\"/>"));
        }
    }
    line(format_args!("  </ModelStructure>\n</fmiModelDescription>"));
    text
}

/// Outputs with their value references: those of sensors that the scene has, with the name of each.
fn outputs(scene: &Scene) -> Vec<(usize, Variable, Option<String>)> {
    let sensors = scene.output.sensors.len().min(SENSORS);
    let used = OUTPUTS.into_iter().take(BEFORE_SENSORS + 2 * sensors).enumerate();
    used.map(|(n, variable)| {
        let sensor = n.checked_sub(BEFORE_SENSORS).map(|n| scene.output.sensors[n / 2].name.clone());
        (1 + INPUTS.len() + n, variable, sensor)
    })
    .collect()
}

fn float(reference: usize, variable: &Variable, causality: &str, sensor: Option<&str>) -> String {
    let Variable { name, unit, description } = variable;
    let of = sensor.map_or_else(String::new, |name| format!(" ({})", escaped(name)));
    format!(
        "    <Float64 name=\"{name}\" valueReference=\"{reference}\" {causality} variability=\"continuous\" \
         unit=\"{unit}\" description=\"{description}{of}\"/>"
    )
}

/// As the value of an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
