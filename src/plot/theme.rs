use super::Ink;

/// A colour as it is coded in files: red, green, blue (sRGB) and opacity.
pub type Color = [u8; 4];

/// Colours of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// Behind everything; opacity 0 leaves it out.
    pub background: Color,
    /// Titles and notes.
    pub text: Color,
    /// Labels, and what explains a curve.
    pub muted: Color,
    /// Lines at ticks.
    pub grid: Color,
    /// The lines through zero.
    pub axis: Color,
    /// What must be seen first.
    pub accent: Color,
    /// Data, in order of use.
    pub series: [Color; 6],
}

const fn rgb(code: u32) -> Color {
    [(code >> 16) as u8, (code >> 8) as u8, code as u8, 255]
}

impl Theme {
    /// On white.
    pub const LIGHT: Theme = Theme {
        background: rgb(0xff_ff_ff),
        text: rgb(0x22_26_2b),
        muted: rgb(0x6b_72_7b),
        grid: rgb(0xe7_e9_ec),
        axis: rgb(0xb4_ba_c1),
        accent: rgb(0xc4_2b_1c),
        series: [
            rgb(0x00_72_b2),
            rgb(0xd5_5e_00),
            rgb(0x00_9e_73),
            rgb(0xcc_79_a7),
            rgb(0xe6_9f_00),
            rgb(0x56_b4_e9),
        ],
    };

    /// On near black.
    pub const DARK: Theme = Theme {
        background: rgb(0x16_19_1d),
        text: rgb(0xee_f0_f2),
        muted: rgb(0x9a_a3_ad),
        grid: rgb(0x2a_2f_36),
        axis: rgb(0x55_5d_67),
        accent: rgb(0xff_7b_6b),
        series: [
            rgb(0x56_b4_e9),
            rgb(0xf0_8a_3c),
            rgb(0x2f_c4_97),
            rgb(0xe2_9a_c4),
            rgb(0xf0_e4_42),
            rgb(0x9f_c9_ff),
        ],
    };

    /// The colour of an ink.
    pub fn color(&self, ink: Ink) -> Color {
        match ink {
            Ink::Series(index) => self.series[index % self.series.len()],
            Ink::Text => self.text,
            Ink::Muted => self.muted,
            Ink::Accent => self.accent,
        }
    }
}

impl Default for Theme {
    fn default() -> Theme {
        Theme::LIGHT
    }
}
