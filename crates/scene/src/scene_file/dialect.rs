//! The dialect of RON in which scenes are written, and the text and hash of a complete scene.

use ron::extensions::Extensions;
use ron::ser::PrettyConfig;

use crate::scene::Scene;

/// `cage: (…)` means `cage: Some((…))`.
pub fn dialect() -> ron::Options {
    let extensions =
        Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES | Extensions::UNWRAP_VARIANT_NEWTYPES;
    ron::Options::default().with_default_extension(extensions)
}

impl Scene {
    /// The complete scene, every default included, as a scene file that reads back to an equal scene.
    pub fn to_ron(&self) -> String {
        let pretty = PrettyConfig::new().indentor("    ").new_line("\n");
        // The structs hold only text, numbers and lists, which RON can always write.
        let body = dialect().to_string_pretty(self, pretty).unwrap_or_default();
        body + "\n"
    }

    /// Name of the scene's content: FNV-1a, 64 bits, of [`Scene::to_ron`], 16 hexadecimal digits.
    ///
    /// Two files with the same fields have the same hash, whatever their comments and omitted defaults. A
    /// field that came after the first scenes counts where it is used: their hashes stay, and so do their
    /// runs and checkpoints.
    pub fn hash(&self) -> String {
        const LATER: [&str; 12] = [
            "defects: [],",
            "ring: outer,",
            "edge_slope_deg: 90.0,",
            "designation: \"\",",
            "model: full,",
            "stiffness_damping_ns: 0.0,",
            "structural_damping: None,",
            "film: None,",
            "roller_phase_deg: 0.0,",
            "roller_offsets_um: [],",
            "pocket: corners,",
            "formula: element_layer,",
        ];
        const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(PRIME);
        let text = self.to_ron();
        let lines = text.split_inclusive('\n').filter(|line| !LATER.contains(&line.trim()));
        format!("{:016x}", lines.flat_map(str::bytes).fold(OFFSET_BASIS, fold))
    }
}
