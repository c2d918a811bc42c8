//! PNG pictures.

use std::io::{self, BufWriter, Write};

/// Writes a picture of `width` pixels a row: eight bits for each of red, green, blue and opacity, sRGB, rows from the
/// top. Where nothing is transparent, opacity is left out. The same pixels give the same bytes.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] when `pixels` is empty or not made of whole rows; else what `out` reports.
pub fn write(width: u32, pixels: &[[u8; 4]], out: &mut dyn Write) -> io::Result<()> {
    let invalid = |reason: &str| io::Error::new(io::ErrorKind::InvalidInput, reason);
    if width == 0 || pixels.is_empty() || !pixels.len().is_multiple_of(width as usize) {
        return Err(invalid("a picture is made of whole rows"));
    }
    let height =
        u32::try_from(pixels.len() / width as usize).map_err(|_| invalid("a picture is too high"))?;
    let opaque = pixels.iter().all(|pixel| pixel[3] == u8::MAX);
    let channels = if opaque { 3 } else { 4 };
    let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| &pixel[..channels]).copied().collect();

    let mut encoder = png::Encoder::new(BufWriter::new(out), width, height);
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> (u32, png::ColorType, Vec<u8>) {
        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().expect("a header");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut pixels).expect("a frame");
        (info.width, info.color_type, pixels)
    }

    #[test]
    fn a_decoder_reads_the_same_pixels() {
        let opaque: Vec<[u8; 4]> = (0..=254_u8).map(|i| [i, 255 - i, i / 3, 255]).collect();
        let mut bytes = Vec::new();
        write(17, &opaque, &mut bytes).expect("written");
        let expected: Vec<u8> = opaque.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
        assert_eq!(read(&bytes), (17, png::ColorType::Rgb, expected));

        let glass = [[1, 2, 3, 4], [5, 6, 7, 255]];
        bytes.clear();
        write(1, &glass, &mut bytes).expect("written");
        assert_eq!(read(&bytes), (1, png::ColorType::Rgba, glass.concat()));
    }

    #[test]
    fn broken_rows_and_broken_pipes_are_errors() {
        let pixels = [[0; 4]; 5];
        for width in [0, 2, 6] {
            let error = write(width, &pixels, &mut Vec::new()).expect_err("not whole rows");
            assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        }
        let mut short = [0_u8; 20];
        assert!(write(5, &pixels, &mut &mut short[..]).is_err());
    }
}
