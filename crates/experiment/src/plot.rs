//! Line plots as SVG.

use std::fmt::Write as _;

use crate::page::escape;

/// A plot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chart {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub curves: Vec<Curve>,
    /// Whether x and y are logarithmic.
    pub logarithmic: [bool; 2],
    /// Headings of places on the x axis, in place of numbers.
    pub x_ticks: Vec<(f64, String)>,
}

/// A line of a plot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Curve {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// Index of its colour.
    pub color: usize,
    pub dashed: bool,
    /// Whether the points are marked.
    pub marked: bool,
    /// Whether no line joins the points.
    pub unconnected: bool,
}

/// Colours that colour-blind eyes tell apart (Okabe and Ito 2008).
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#444444"];
const WIDTH: f64 = 620.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 600.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 300.0;
/// Width of a legend's column and height of its rows.
const LEGEND: [f64; 2] = [270.0, 18.0];

/// A scale from values to places along an axis.
struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    from: f64,
    to: f64,
}

impl Scale {
    fn new(values: impl Iterator<Item = f64>, logarithmic: bool, from: f64, to: f64) -> Self {
        let usable = values.filter(|value| value.is_finite() && (!logarithmic || *value > 0.0));
        let (low, high) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (mut low, mut high) = if low <= high { (low, high) } else { (1.0, 10.0) };
        if logarithmic {
            (low, high) = (low / 1.15, high * 1.15);
        } else if low == high {
            (low, high) = (low - 0.5, high + 0.5);
        }
        Self { low, high, logarithmic, from, to }
    }

    /// An axis for values that are no less than 0: it begins there.
    fn starting_at_zero(self) -> Self {
        if self.logarithmic || self.low < 0.0 { self } else { Self { low: 0.0, high: self.high * 1.05, ..self } }
    }

    fn place(&self, value: f64) -> f64 {
        let share = match self.logarithmic {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        self.from + share * (self.to - self.from)
    }

    /// Round numbers on the axis.
    fn ticks(&self) -> Vec<f64> {
        if self.logarithmic {
            let decades = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
            let few = self.high / self.low > 300.0;
            let factors: &[f64] = if few { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let all = decades.flat_map(|decade| factors.iter().map(move |factor| factor * 10f64.powi(decade)));
            return all.filter(|tick| (self.low..=self.high).contains(tick)).collect();
        }
        let rough = (self.high - self.low) / 5.0;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let first = (self.low / step).ceil() as i64;
        (first..).map(|k| k as f64 * step).take_while(|tick| *tick <= self.high + 1e-9 * step).take(20).collect()
    }
}

/// A tick's number without needless zeros.
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{}", (value * 1e6).round() / 1e6)
    }
}

impl Chart {
    /// The plot as a `<svg>` element, which is a file of its own as well.
    pub fn svg(&self) -> String {
        let coordinates = |axis: usize| self.curves.iter().flat_map(move |c| c.points.iter().map(move |p| p[axis]));
        let ticked = coordinates(0).chain(self.x_ticks.iter().map(|(x, _)| *x));
        let x = Scale::new(ticked, self.logarithmic[0], LEFT, RIGHT);
        let y = Scale::new(coordinates(1), self.logarithmic[1], BOTTOM, TOP).starting_at_zero();
        let height = BOTTOM + 52.0 + LEGEND[1] * self.curves.len().div_ceil(2) as f64;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#333\">\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\
             <text x=\"{LEFT}\" y=\"20\" font-size=\"14\" font-weight=\"600\">{}</text>",
            escape(&self.title)
        );
        self.draw_axes(&mut svg, &x, &y);
        for curve in &self.curves {
            draw_curve(&mut svg, curve, &x, &y, self.logarithmic);
        }
        self.draw_legend(&mut svg);
        svg + "</svg>\n"
    }

    fn draw_axes(&self, svg: &mut String, x: &Scale, y: &Scale) {
        for tick in y.ticks() {
            let at = y.place(tick);
            let _ = write!(
                svg,
                "<path d=\"M{LEFT} {at:.1}H{RIGHT}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 6.0,
                at + 4.0,
                number(tick)
            );
        }
        let numbers = || x.ticks().into_iter().map(|tick| (tick, number(tick))).collect();
        let ticks: Vec<(f64, String)> = if self.x_ticks.is_empty() { numbers() } else { self.x_ticks.clone() };
        for (tick, label) in ticks {
            let at = x.place(tick);
            let _ = write!(
                svg,
                "<path d=\"M{at:.1} {BOTTOM}v5\" stroke=\"#333\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                BOTTOM + 18.0,
                escape(&label)
            );
        }
        let _ = write!(
            svg,
            "<path d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" stroke=\"#333\"/>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            0.5 * (LEFT + RIGHT),
            BOTTOM + 36.0,
            escape(&self.x_label),
            0.5 * (TOP + BOTTOM),
            escape(&self.y_label)
        );
    }

    fn draw_legend(&self, svg: &mut String) {
        for (index, curve) in self.curves.iter().enumerate() {
            let x = LEFT + LEGEND[0] * (index % 2) as f64;
            let y = BOTTOM + 56.0 + LEGEND[1] * (index / 2) as f64;
            if curve.unconnected {
                let _ =
                    write!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"3.5\" fill=\"{}\"/>", x + 12.0, y - 4.0, color(curve));
                let _ = write!(svg, "<text x=\"{}\" y=\"{y}\">{}</text>", x + 30.0, escape(&curve.name));
                continue;
            }
            let _ = write!(
                svg,
                "<path d=\"M{x} {}h24\" stroke=\"{}\" stroke-width=\"2\"{}/><text x=\"{}\" y=\"{y}\">{}</text>",
                y - 4.0,
                color(curve),
                dashes(curve),
                x + 30.0,
                escape(&curve.name)
            );
        }
    }
}

fn color(curve: &Curve) -> &'static str {
    COLORS[curve.color % COLORS.len()]
}

fn dashes(curve: &Curve) -> &'static str {
    if curve.dashed { " stroke-dasharray=\"6 4\"" } else { "" }
}

fn draw_curve(svg: &mut String, curve: &Curve, x: &Scale, y: &Scale, logarithmic: [bool; 2]) {
    let drawable = |p: &&[f64; 2]| (0..2).all(|axis| p[axis].is_finite() && (!logarithmic[axis] || p[axis] > 0.0));
    let places: Vec<_> = curve.points.iter().filter(drawable).map(|p| [x.place(p[0]), y.place(p[1])]).collect();
    let path: Vec<_> = places.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    if places.len() > 1 && !curve.unconnected {
        let _ = write!(
            svg,
            "<path d=\"M{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"{}/>",
            path.join("L"),
            color(curve),
            dashes(curve)
        );
    }
    for [x, y] in places.iter().filter(|_| curve.marked) {
        let _ = write!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"{}\"/>", color(curve));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks = Scale::new([0.0, 9.3].into_iter(), false, 0.0, 1.0).ticks();
        assert_eq!(ticks, [0.0, 2.0, 4.0, 6.0, 8.0]);
        let ticks = Scale::new([30.0, 2000.0].into_iter(), true, 0.0, 1.0).ticks();
        assert_eq!(ticks, [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0]);
        assert!(!Scale::new([].into_iter(), true, 0.0, 1.0).ticks().is_empty());
    }

    #[test]
    fn a_plot_is_well_formed_and_escapes_names() {
        let points = vec![[1.0, 2.0], [10.0, f64::NAN], [100.0, 4.0]];
        let curve = Curve { name: "a < b".to_owned(), points, marked: true, ..Curve::default() };
        let chart =
            Chart { title: "\"&\"".to_owned(), curves: vec![curve], logarithmic: [true, true], ..Chart::default() };
        let svg = chart.svg();
        assert!(svg.contains("a &lt; b") && svg.contains("&quot;&amp;&quot;") && !svg.contains("NaN"), "{svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
    }
}
