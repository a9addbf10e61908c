//! Plots over logarithmic and linear axes, as SVG and PNG, with a font of their own: nothing needs to be installed.

use crate::picture::{Provenance, encoder};
use files::Folder;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};
use std::io::Write;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Once;

/// Size of a plot in points; the PNG has [`PNG_SCALE`] pixels for each.
const SIZE: (u32, u32) = (860, 500);
const PNG_SCALE: u32 = 2;
/// More points than these are drawn as a curve.
const CURVE: usize = 24;
/// Name under which the embedded font is known to the plotting library, and a generic family in SVG.
const FONT: &str = "sans-serif";
/// The colour of text and axes.
const DARK: RGBColor = RGBColor(30, 30, 30);
/// Colours of the series: dark enough on white, and told apart by people who do not tell red from green.
const COLORS: [RGBColor; 10] = [
    RGBColor(0, 90, 160),
    RGBColor(200, 80, 0),
    RGBColor(0, 130, 90),
    RGBColor(150, 60, 140),
    RGBColor(190, 20, 40),
    RGBColor(80, 170, 220),
    RGBColor(150, 120, 0),
    RGBColor(120, 120, 120),
    RGBColor(0, 0, 90),
    RGBColor(100, 190, 60),
];

/// Lengths of the strokes of a line, and of the gaps between them, points; one row for each way to draw a line. Curves
/// of one colour are drawn in different ways, for there is no common factor of the colours and the ways.
const STROKES: [(u32, u32); 3] = [(1, 0), (9, 5), (3, 4)];
/// Space around what a plot shows, as a part of its sides.
const MARGIN: f64 = 0.02;
/// Height of a row of the legend, its sample of a line, and the width of a letter, points.
const ROW: u32 = 20;
const SAMPLE: u32 = 26;
const LETTER: f64 = 7.0;
/// The legend is no wider than this, points.
const WIDEST_LEGEND: u32 = 300;

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Even steps.
    Linear,
    /// Even ratios.
    Logarithmic,
}

impl Axis {
    /// Where a number stands on the axis.
    fn position(self, number: f64) -> f64 {
        if self == Axis::Linear { number } else { number.log10() }
    }

    /// The number that stands at a place.
    fn number(self, place: f64) -> f64 {
        if self == Axis::Linear { place } else { 10f64.powf(place) }
    }

    /// The places of the ticks between two places.
    fn ticks(self, low: f64, high: f64) -> Vec<f64> {
        if self == Axis::Logarithmic {
            return ticks(self.number(low), self.number(high)).into_iter().map(f64::log10).collect();
        }
        // Steps of 1, 2 or 5 times a power of ten, ten or so of them.
        let rough = (high - low) / 12.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let count = (high / step).floor() as i64;
        let first = (low / step).ceil() as i64;
        (first..=count).map(|index| index as f64 * step).collect()
    }
}

/// The places along an axis, and those of its ticks.
struct AxisTicks {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl Ranged for AxisTicks {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, limit: (i32, i32)) -> i32 {
        let part = (place - self.range.start) / (self.range.end - self.range.start);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// Curves over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The heading.
    pub title: String,
    /// What the horizontal axis shows, with its unit.
    pub x_label: String,
    /// What the vertical axis shows, with its unit.
    pub y_label: String,
    /// A remark under the heading.
    pub note: String,
    /// How the horizontal axis is divided.
    pub x_axis: Axis,
    /// How the vertical axis is divided; a linear one begins at 0, if nothing is below.
    pub y_axis: Axis,
    /// The curves.
    pub series: Vec<Series>,
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points; those that are no numbers, or not above 0 on a logarithmic axis, have no place there, and no line
    /// leads past them.
    pub points: Vec<PlotPoint>,
}

/// A point of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotPoint {
    /// On the horizontal axis.
    pub x: f64,
    /// On the vertical axis.
    pub y: f64,
    /// What stands beside it.
    pub label: String,
}

/// A fault that keeps a plot from being drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// No point can be shown on the axes.
    #[error("nothing to plot: no point has a place on the axes")]
    Empty,
    /// The plotting library gave up.
    #[error("plot: {0}")]
    Draw(String),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] files::WriteError),
}

impl Plot {
    /// The plot as SVG.
    ///
    /// # Errors
    /// [`PlotError::Empty`] or [`PlotError::Draw`].
    pub fn svg(&self) -> Result<String, PlotError> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area(), 1)?;
        Ok(text)
    }

    /// The plot as pixels, three bytes each, with width and height.
    ///
    /// # Errors
    /// [`PlotError::Empty`] or [`PlotError::Draw`].
    pub fn pixels(&self) -> Result<(Vec<u8>, u32, u32), PlotError> {
        let (width, height) = (SIZE.0 * PNG_SCALE, SIZE.1 * PNG_SCALE);
        let mut bytes = vec![255; (width * height * 3) as usize];
        self.draw(&BitMapBackend::with_buffer(&mut bytes, (width, height)).into_drawing_area(), PNG_SCALE)?;
        Ok((bytes, width, height))
    }

    /// Writes `NAME.svg` and `NAME.png`.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn write(&self, folder: &Folder, name: &str) -> Result<[PathBuf; 2], PlotError> {
        let text = self.svg()?;
        let svg = folder.write_or_save_elsewhere(&format!("{name}.svg"), |file| file.write_all(text.as_bytes()))?;
        let (bytes, width, height) = self.pixels()?;
        let png = format!("{name}.png");
        let png = folder.write_or_save_elsewhere(&png, |file| {
            encoder::png(file, &bytes, [width, height], &Provenance::default())
        })?;
        Ok([svg, png])
    }

    /// Whether a point has a place on the axes.
    fn is_plottable(&self, point: &PlotPoint) -> bool {
        let has_place = |axis: Axis, x: f64| x.is_finite() && (axis == Axis::Linear || x > 0.0);
        has_place(self.x_axis, point.x) && has_place(self.y_axis, point.y)
    }

    /// The points that have a place on the axes.
    fn visible<'a>(&self, series: &'a Series) -> impl Iterator<Item = &'a PlotPoint> {
        series.points.iter().filter(|point| self.is_plottable(point))
    }

    /// Least and greatest place on an axis, with a small margin; on a logarithmic one at least a factor of four apart.
    fn range(&self, axis: Axis, of: impl Fn(&PlotPoint) -> f64) -> Option<(f64, f64)> {
        let values = self.series.iter().flat_map(|series| self.visible(series)).map(of);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return None;
        }
        match axis {
            Axis::Logarithmic => {
                let middle = (low * high).sqrt();
                let [low, high] = [low.min(middle / 2.0), high.max(middle * 2.0)].map(|number| axis.position(number));
                Some((low - MARGIN * (high - low), high + MARGIN * (high - low)))
            }
            Axis::Linear => {
                let span = if high > low { high - low } else { high.abs().max(1.0) };
                Some((low - MARGIN * span, high + MARGIN * span))
            }
        }
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
        scale: u32,
    ) -> Result<(), PlotError> {
        embed_font();
        let (x0, x1) = self.range(self.x_axis, |p| p.x).ok_or(PlotError::Empty)?;
        let (y0, y1) = self.range(self.y_axis, |p| p.y).ok_or(PlotError::Empty)?;
        // What is never negative begins at 0.
        let is_above =
            self.y_axis == Axis::Linear && self.series.iter().flat_map(|s| self.visible(s)).all(|p| p.y >= 0.0);
        let y0 = if is_above { 0.0 } else { y0 };
        let (x_ticks, y_ticks) = (self.x_axis.ticks(x0, x1), self.y_axis.ticks(y0, y1));
        let (x_axis, y_axis) = (self.x_axis, self.y_axis);
        area.fill(&WHITE).map_err(|e| failed(&e))?;
        let (head, body) = area.split_vertically(54 * scale);
        let text = |size: u32| text_style(size, scale);
        let at = |x: u32, y: u32| ((x * scale) as i32, (y * scale) as i32);
        head.draw_text(&self.title, &text(18), at(16, 10)).map_err(|e| failed(&e))?;
        head.draw_text(&self.note, &text(13), at(16, 34)).map_err(|e| failed(&e))?;
        let longest = self.series.iter().map(|series| series.name.chars().count()).max().unwrap_or(0);
        let legend_width = (SAMPLE + 24 + (longest as f64 * LETTER) as u32).min(WIDEST_LEGEND);
        let (body, legend) = body.split_horizontally((SIZE.0 - legend_width) * scale);
        let mut chart = ChartBuilder::on(&body)
            .margin(8 * scale)
            .margin_right(12 * scale)
            .x_label_area_size(46 * scale)
            .y_label_area_size(74 * scale)
            .build_cartesian_2d(
                AxisTicks { range: x0..x1, ticks: x_ticks },
                AxisTicks { range: y0..y1, ticks: y_ticks },
            )
            .map_err(|e| failed(&e))?;
        chart
            .configure_mesh()
            .x_desc(self.x_label.as_str())
            .y_desc(self.y_label.as_str())
            .x_label_formatter(&|x| tick_text(x_axis.number(*x)))
            .y_label_formatter(&|y| tick_text(y_axis.number(*y)))
            .label_style(text(13))
            .axis_desc_style(text(15))
            .axis_style(DARK.stroke_width(scale))
            .bold_line_style(RGBColor(215, 215, 215).stroke_width(scale))
            .light_line_style(TRANSPARENT)
            .set_all_tick_mark_size(5 * scale)
            .draw()
            .map_err(|e| failed(&e))?;
        // Rows of the legend come closer where there are many.
        let row = ROW.min((SIZE.1 - 70) / self.series.len().max(1) as u32);
        for (index, series) in self.series.iter().enumerate() {
            let look = SeriesLook {
                color: COLORS[index % COLORS.len()],
                strokes: STROKES[index % STROKES.len()],
                // Many points are a curve.
                dot: if self.visible(series).count() > CURVE { 1 } else { 4 },
                scale,
            };
            self.draw_series(&mut chart, series, look)?;
            look.draw_legend(&legend, &series.name, 20 + row * index as u32)?;
        }
        area.present().map_err(|e| failed(&e))
    }

    /// Draws a series: its strokes, its points and their labels.
    fn draw_series<B: DrawingBackend>(
        &self,
        chart: &mut ChartContext<'_, B, Cartesian2d<AxisTicks, AxisTicks>>,
        series: &Series,
        SeriesLook { color, strokes, dot, scale }: SeriesLook,
    ) -> Result<(), PlotError> {
        let place = |p: &PlotPoint| (self.x_axis.position(p.x), self.y_axis.position(p.y));
        let style = color.stroke_width(2 * scale);
        for run in series.points.split(|point| !self.is_plottable(point)) {
            let line = || run.iter().map(place);
            let drawn = match strokes {
                (_, 0) => chart.draw_series(LineSeries::new(line(), style)).map(drop),
                (on, off) => chart.draw_series(DashedLineSeries::new(line(), on * scale, off * scale, style)).map(drop),
            };
            drawn.map_err(|e| failed(&e))?;
            chart.draw_series(line().map(|at| Circle::new(at, dot * scale, color.filled()))).map_err(|e| failed(&e))?;
        }
        // Errors fall as time grows: below and to the left of the last curve there is room.
        let corner = Pos::new(HPos::Right, VPos::Top);
        let small = TextStyle::from((FONT, f64::from(12 * scale))).color(&color).pos(corner);
        let beside_point = (-6 * scale as i32, 3 * scale as i32);
        let beside =
            |p: &PlotPoint| EmptyElement::at(place(p)) + Text::new(p.label.clone(), beside_point, small.clone());
        chart.draw_series(self.visible(series).map(beside)).map_err(|e| failed(&e))?;
        Ok(())
    }
}

/// How a series looks.
#[derive(Clone, Copy)]
struct SeriesLook {
    color: RGBColor,
    /// Lengths of strokes and of the gaps between them; no gap for an unbroken line.
    strokes: (u32, u32),
    /// Radius of points.
    dot: u32,
    /// Pixels per unit.
    scale: u32,
}

impl SeriesLook {
    /// Draws its row of a legend.
    ///
    /// - `middle`: of the row, from above.
    fn draw_legend<B: DrawingBackend>(
        self,
        legend: &DrawingArea<B, plotters::coord::Shift>,
        name: &str,
        middle: u32,
    ) -> Result<(), PlotError> {
        let SeriesLook { color, strokes: (on, off), dot, scale } = self;
        let at = |x: u32, y: u32| ((x * scale) as i32, (y * scale) as i32);
        let gap = if off == 0 { SAMPLE } else { on + off };
        for begin in (0..SAMPLE).step_by(gap as usize) {
            let end = (begin + if off == 0 { SAMPLE } else { on }).min(SAMPLE);
            let stroke = PathElement::new([at(begin, middle), at(end, middle)], color.stroke_width(2 * scale));
            legend.draw(&stroke).map_err(|e| failed(&e))?;
        }
        let sample = Circle::new(at(SAMPLE / 2, middle), dot.min(3) * scale, color.filled());
        legend.draw(&sample).map_err(|e| failed(&e))?;
        let style = text_style(14, scale).pos(Pos::new(HPos::Left, VPos::Center));
        legend.draw_text(name, &style, at(SAMPLE + 8, middle)).map_err(|e| failed(&e))
    }
}

fn failed(error: &dyn std::fmt::Display) -> PlotError {
    PlotError::Draw(error.to_string())
}

/// Dark text of a size.
fn text_style(size: u32, scale: u32) -> TextStyle<'static> {
    TextStyle::from((FONT, f64::from(size * scale))).color(&DARK)
}

/// Makes the embedded font known, once.
fn embed_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // A font that cannot be read shows itself as a drawing error.
        let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

/// Decades between two numbers; with 2 and 5 in between if there are few.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let decades = (high / low).log10();
    let steps: &[f64] = if decades > 4.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let exponents = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let all = exponents.flat_map(|e| steps.iter().map(move |s| s * 10f64.powi(e)));
    all.filter(|t| (low..=high).contains(t)).collect()
}

fn tick_text(x: f64) -> String {
    if x == 0.0 {
        "0".into()
    } else if (0.999e-3..1e4).contains(&x) {
        let rounded = format!("{x:.4}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{x:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Plot {
        let point = |i: i32| PlotPoint { x: 0.01 * 2f64.powi(i), y: 0.1 * 0.6f64.powi(i), label: (1 << i).to_string() };
        Plot {
            title: "A title".into(),
            x_label: "run time (s)".into(),
            y_label: "error".into(),
            note: "labels: samples".into(),
            x_axis: Axis::Logarithmic,
            y_axis: Axis::Logarithmic,
            series: vec![Series { name: "RMSE".into(), points: (0..6).map(point).collect() }],
        }
    }

    #[test]
    fn an_svg_names_axes_ticks_and_curves() {
        let svg = sample().svg().expect("drawn");
        for text in ["A title", "run time (s)", "error", "RMSE", "labels: samples", "0.05", "0.1", "\n32\n"] {
            assert!(svg.contains(text), "{text}");
        }
    }

    #[test]
    fn a_bitmap_holds_text_and_curve() {
        let (bytes, width, height) = sample().pixels().expect("drawn");
        assert_eq!(bytes.len(), (width * height * 3) as usize);
        let blue = bytes.chunks(3).filter(|p| *p == [0, 90, 160]).count();
        let dark = bytes.chunks(3).filter(|p| p.iter().all(|c| *c < 60)).count();
        assert!(blue > 500 && dark > 500, "{blue} of the curve, {dark} of text and axes");
    }

    #[test]
    fn a_linear_axis_has_even_ticks() {
        assert_eq!(Axis::Linear.ticks(0.0, 90.0), [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0]);
        assert_eq!(Axis::Linear.ticks(-0.01, 0.1).iter().filter(|tick| **tick < 0.0).count(), 1);
        let mut plot = Plot { x_axis: Axis::Linear, y_axis: Axis::Linear, ..sample() };
        plot.series[0]
            .points
            .iter_mut()
            .enumerate()
            .for_each(|(i, p)| (p.x, p.y) = (380.0 + 80.0 * i as f64, 0.1 * i as f64));
        let svg = plot.svg().expect("drawn");
        for text in ["\n400\n", "\n700\n", "\n0\n", "\n0.5\n"] {
            assert!(svg.contains(text), "{text}");
        }
    }

    #[test]
    fn nothing_above_zero_is_an_error() {
        let mut plot = sample();
        plot.series[0].points.iter_mut().for_each(|p| p.y = 0.0);
        assert!(matches!(plot.svg(), Err(PlotError::Empty)));
    }

    #[test]
    fn ticks_are_decades_or_finer() {
        assert_eq!(ticks(0.009, 0.6), [0.01, 0.02, 0.05, 0.1, 0.2, 0.5]);
        assert_eq!(tick_text(0.001), "0.001");
        assert_eq!(tick_text(1e-6), "1e-6");
    }
}
