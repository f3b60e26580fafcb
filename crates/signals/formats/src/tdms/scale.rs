//! Scales of TDMS channels: `NI_Scale[n]_…` define the conversion of stored counts to physical values.
//!
//! A scale works on the stored numbers or on the result of another one; the last is what LabVIEW shows.

use std::collections::BTreeMap;

use crate::curve::Curve;
use crate::tdms::Property;

type Properties = BTreeMap<String, Property>;

/// Input of a scale that works on the stored numbers.
const STORED: f64 = u32::MAX as f64;
/// Scales of a channel, and numbers of a scale, at most.
const MOST: usize = 10_000;

pub(crate) fn count(of: &Properties) -> usize {
    match of.get("NI_Number_Of_Scales") {
        Some(Property::Number(n)) => (n.max(0.0) as usize).min(MOST),
        _ => {
            let index = |key: &String| {
                key.strip_prefix("NI_Scale[")?.strip_suffix("]_Scale_Type")?.parse::<usize>().ok()
            };
            of.keys().filter_map(index).max().map_or(0, |n| n.min(MOST) + 1)
        }
    }
}

/// The law of the last scale; `None` where stored numbers are values, otherwise why the channel cannot be
/// read. The scale of number `raw`, of no type, stands for the stored numbers of DAQmx.
pub(crate) fn curve(of: &Properties, raw: Option<u32>) -> Result<Option<Curve>, String> {
    let scaled = matches!(of.get("NI_Scaling_Status"), Some(Property::Text(status)) if status == "scaled");
    let count = count(of);
    if scaled || count == 0 {
        return Ok(None);
    }
    // From the last scale back to the stored numbers.
    let (mut chain, mut at) = (Vec::new(), count - 1);
    loop {
        let prefix = format!("NI_Scale[{at}]_");
        let Some(Property::Text(sort)) = of.get(&format!("{prefix}Scale_Type")) else {
            if raw.is_some_and(|id| id as usize == at) {
                break;
            }
            return Err(format!("its scale {at} does not say its type"));
        };
        let number = |name: &str| match of.get(&format!("{prefix}{sort}_{name}")) {
            Some(Property::Number(x)) => Some(*x),
            _ => None,
        };
        let missing = |name: &str| format!("its scale {at} (`{sort}`) has no `{name}`");
        let need = |name: &str| number(name).ok_or_else(|| missing(name));
        let all = |name: &str, size: usize| -> Result<Vec<f64>, String> {
            (0..size.min(MOST)).map(|n| need(&format!("{name}[{n}]"))).collect()
        };
        match sort.as_str() {
            "Linear" => chain.push(Curve::linear(need("Y_Intercept")?, need("Slope")?)),
            "Polynomial" => {
                let size = number("Coefficients_Size").unwrap_or(4.0);
                chain.push(Curve::Polynomial(all("Coefficients", size as usize)?));
            }
            "Table" => {
                let size = need("Pre_Scaled_Values_Size")? as usize;
                let (x, y) = (all("Pre_Scaled_Values", size)?, all("Scaled_Values", size)?);
                let table = Curve::table(&x, &y, true);
                chain.push(table.ok_or_else(|| format!("the table of its scale {at} does not ascend"))?);
            }
            "AdvancedAPI" => {}
            other => {
                return Err(format!(
                    "its scale `{other}` is not applied (Linear, Polynomial and Table are): save scaled \
                     values"
                ));
            }
        }
        let input = number("Input_Source").unwrap_or(STORED);
        if input == STORED {
            break;
        }
        // A scale works on one before it.
        if input < 0.0 || input >= at as f64 {
            return Err(format!("its scale {at} works on a scale {input}, which does not come before it"));
        }
        at = input as usize;
    }
    if chain.is_empty() {
        return Ok(None);
    }
    chain.reverse();
    Ok(Some(if chain.len() == 1 { chain.swap_remove(0) } else { Curve::Chain(chain) }))
}
