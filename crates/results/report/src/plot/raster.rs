//! Pixels from SVG, with a font of our own: every machine draws the same letters.

use std::sync::{Arc, OnceLock};

use resvg::{tiny_skia, usvg};

use crate::Error;

/// Pixels a unit of the drawing.
const SCALE: f32 = 1.5;

/// The drawing as PNG, 1.5 pixels a unit. `name` is for the message.
pub fn png(name: &str, svg: &str) -> Result<Vec<u8>, Error> {
    scaled(name, svg, SCALE)
}

/// The same, `scale` pixels a unit.
pub(super) fn scaled(name: &str, svg: &str, scale: f32) -> Result<Vec<u8>, Error> {
    let failed = |why: String| Error::Drawing { figure: name.to_owned(), why };
    let options = usvg::Options { fontdb: fonts(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|why| failed(why.to_string()))?;
    let size = tree.size();
    let pixels = |length: f32| (length * scale).ceil() as u32;
    let mut pixmap = tiny_skia::Pixmap::new(pixels(size.width()), pixels(size.height()))
        .ok_or_else(|| failed("the picture has no size".into()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    encoded(&pixmap).map_err(|why| failed(why.to_string()))
}

/// The pixels as PNG, compressed for speed: the smallest file took half of a report's time.
fn encoded(pixmap: &tiny_skia::Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    // Figures have a ground of their own, so that no pixel is transparent.
    let colours = pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]);
    writer.write_image_data(&colours.collect::<Vec<u8>>())?;
    writer.finish()?;
    Ok(file)
}

fn fonts() -> Arc<usvg::fontdb::Database> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    let load = || {
        let mut database = usvg::fontdb::Database::new();
        database.load_font_data(without_old_kerning(dejavu::sans::regular()));
        database.set_sans_serif_family("DejaVu Sans");
        Arc::new(database)
    };
    Arc::clone(FONTS.get_or_init(load))
}

/// The font with its table `kern` under a name that nobody asks for: its pairs are in the table `GPOS`, which
/// goes before, but whoever sets a word would read both of them anew.
fn without_old_kerning(font: &[u8]) -> Vec<u8> {
    // A font begins with twelve bytes and the places of its tables, sixteen bytes each, by name.
    const HEAD: usize = 12;
    const ENTRY: usize = 16;
    let mut font = font.to_vec();
    let tables = usize::from(u16::from_be_bytes([font[4], font[5]]));
    let entries = font[HEAD..].chunks_exact_mut(ENTRY).take(tables);
    for entry in entries.filter(|entry| entry.starts_with(b"kern")) {
        entry[..4].copy_from_slice(b"kero");
    }
    font
}
