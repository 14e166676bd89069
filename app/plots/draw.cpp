#include "app/plots/draw.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "projects/safe_file.h"

namespace ilf::app {
namespace {

constexpr double kWidth = 900.0, kHeight = 560.0, kPixelsPerUnit = 2.0;
constexpr double kText = 13.0, kTitle = 16.0, kSmall = 11.0, kGap = 8.0;

struct Colour {
    double r, g, b;
};
constexpr Colour kInk{0.10, 0.12, 0.15}, kDim{0.40, 0.44, 0.49}, kGrid{0.87, 0.89, 0.91};
/// Okabe and Ito's, without their yellow, which white paper swallows.
constexpr std::array<Colour, 7> kPalette{{{0.00, 0.45, 0.70},
                                          {0.84, 0.37, 0.00},
                                          {0.00, 0.62, 0.45},
                                          {0.80, 0.47, 0.65},
                                          {0.34, 0.71, 0.91},
                                          {0.90, 0.62, 0.00},
                                          {0.25, 0.25, 0.25}}};

/// Text, lines and dots in chart units.
class Pen {
public:
    explicit Pen(cairo_t* cairo) : cairo_(cairo) {
        cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
        cairo_set_source_rgb(cairo_, 1.0, 1.0, 1.0);
        cairo_paint(cairo_);
    }
    void colour(Colour c) { cairo_set_source_rgb(cairo_, c.r, c.g, c.b); }
    void font(double size, bool bold = false) {
        cairo_select_font_face(cairo_, "Inter", CAIRO_FONT_SLANT_NORMAL,
                               bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cairo_, size);
    }
    double widthOf(const std::string& text) {
        cairo_text_extents_t extents;
        cairo_text_extents(cairo_, text.c_str(), &extents);
        return extents.x_advance;
    }
    /// `align` 0: x is the left end, 0.5: the middle, 1: the right end; y is the baseline.
    void text(double x, double y, double align, const std::string& words) {
        cairo_move_to(cairo_, x - align * widthOf(words), y);
        cairo_show_text(cairo_, words.c_str());
    }
    void uprightText(double x, double y, const std::string& words) {
        cairo_save(cairo_);
        cairo_translate(cairo_, x, y);
        cairo_rotate(cairo_, -0.5 * std::numbers::pi);
        text(0.0, 0.0, 0.5, words);
        cairo_restore(cairo_);
    }
    void segment(double x0, double y0, double x1, double y1, double width, bool dashed = false) {
        const double dashes[] = {7.0, 5.0};
        cairo_set_dash(cairo_, dashes, dashed ? 2 : 0, 0.0);
        cairo_set_line_width(cairo_, width);
        cairo_move_to(cairo_, x0, y0);
        cairo_line_to(cairo_, x1, y1);
        cairo_stroke(cairo_);
        cairo_set_dash(cairo_, nullptr, 0, 0.0);
    }
    void dot(double x, double y, bool hollow) {
        constexpr double kRadius = 3.6;
        cairo_new_path(cairo_);
        cairo_arc(cairo_, x, y, hollow ? kRadius + 0.9 : kRadius, 0.0, 2.0 * std::numbers::pi);
        cairo_set_line_width(cairo_, 1.6);
        hollow ? cairo_stroke(cairo_) : cairo_fill(cairo_);
    }
    cairo_t* cairo() { return cairo_; }

private:
    cairo_t* cairo_;
};

/// Where the plot lies between its labels, and where a value lies in it.
struct Frame {
    double left, top, right, bottom;
    const Chart& chart;

    double x(double value) const {
        return left + (right - left) * (value - chart.x.low) / (chart.x.high - chart.x.low);
    }
    double y(double value) const {
        return bottom - (bottom - top) * (value - chart.y.low) / (chart.y.high - chart.y.low);
    }
};

constexpr double kSwatch = 26.0;

double legendWidth(Pen& pen, const Chart& chart) {
    pen.font(kText);
    double widest = 0.0;
    for (const Curve& curve : chart.curves) {
        if (!curve.label.empty()) widest = std::max(widest, pen.widthOf(curve.label));
    }
    return widest > 0.0 ? widest + kSwatch + 3.0 * kGap : 0.0;
}

Frame frameOf(Pen& pen, const Chart& chart) {
    pen.font(kText);
    double widest = 0.0;
    for (const std::string& words : tickWords(ticks(chart.y.low, chart.y.high, 7)))
        widest = std::max(widest, pen.widthOf(words));
    return {2.0 * kGap + kText + widest + kGap, 3.0 * kGap + kTitle, kWidth - 3.0 * kGap - legendWidth(pen, chart),
            kHeight - (chart.note.empty() ? 0.0 : kSmall + 2.0 * kGap) - 2.0 * kText - 3.5 * kGap, chart};
}

void axes(Pen& pen, const Frame& f) {
    const Chart& chart = f.chart;
    pen.font(kText);
    const auto across = ticks(chart.x.low, chart.x.high, 9), up = ticks(chart.y.low, chart.y.high, 7);
    const auto acrossWords = tickWords(across), upWords = tickWords(up);
    for (std::size_t i = 0; i < across.size(); ++i) {
        pen.colour(kGrid);
        pen.segment(f.x(across[i]), f.top, f.x(across[i]), f.bottom, 1.0);
        pen.colour(kInk);
        pen.text(f.x(across[i]), f.bottom + kText + 0.6 * kGap, 0.5, acrossWords[i]);
    }
    for (std::size_t i = 0; i < up.size(); ++i) {
        pen.colour(kGrid);
        pen.segment(f.left, f.y(up[i]), f.right, f.y(up[i]), 1.0);
        pen.colour(kInk);
        pen.text(f.left - kGap, f.y(up[i]) + 0.36 * kText, 1.0, upWords[i]);
    }
    pen.colour(kInk);
    pen.segment(f.left, f.bottom, f.right, f.bottom, 1.4);
    pen.segment(f.left, f.top, f.left, f.bottom, 1.4);
    pen.text(0.5 * (f.left + f.right), f.bottom + 2.0 * kText + 1.9 * kGap, 0.5, chart.x.title);
    pen.uprightText(kGap + kText, 0.5 * (f.top + f.bottom), chart.y.title);
    pen.font(kTitle, true);
    pen.text(f.left, kGap + kTitle, 0.0, chart.title);
    pen.font(kSmall);
    pen.colour(kDim);
    pen.text(f.left, kHeight - kGap, 0.0, chart.note);
}

Colour colourOf(const Curve& curve) {
    const int count = static_cast<int>(kPalette.size());
    return kPalette[static_cast<std::size_t>(((curve.colour % count) + count) % count)];
}

void line(Pen& pen, const Frame& f, const Curve& curve) {
    const double dashes[] = {7.0, 5.0};
    cairo_t* cairo = pen.cairo();
    cairo_set_dash(cairo, dashes, curve.mark == Mark::dashed ? 2 : 0, 0.0);
    cairo_set_line_width(cairo, 2.0);
    bool drawing = false;
    for (const ChartPoint& p : curve.points) {
        const bool there = std::isfinite(p.x) && std::isfinite(p.y);
        if (there && drawing) cairo_line_to(cairo, f.x(p.x), f.y(p.y));
        if (there && !drawing) cairo_move_to(cairo, f.x(p.x), f.y(p.y));
        drawing = there;
    }
    cairo_stroke(cairo);
    cairo_set_dash(cairo, nullptr, 0, 0.0);
}

void dots(Pen& pen, const Frame& f, const Curve& curve) {
    for (const ChartPoint& p : curve.points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
        if (p.spread > 0.0) {
            const double x = f.x(p.x), high = f.y(p.y + p.spread), low = f.y(p.y - p.spread);
            pen.segment(x, high, x, low, 1.2);
            pen.segment(x - 3.0, high, x + 3.0, high, 1.2);
            pen.segment(x - 3.0, low, x + 3.0, low, 1.2);
        }
        pen.dot(f.x(p.x), f.y(p.y), curve.mark == Mark::rings);
    }
}

bool asLine(const Curve& curve) { return curve.mark == Mark::line || curve.mark == Mark::dashed; }

void curves(Pen& pen, const Frame& f) {
    for (const Curve& curve : f.chart.curves) {
        // Dots on the edge of the plot are shown whole.
        const double room = asLine(curve) ? 0.0 : 6.0;
        cairo_save(pen.cairo());
        cairo_rectangle(pen.cairo(), f.left - room, f.top - room, f.right - f.left + 2.0 * room,
                        f.bottom - f.top + 2.0 * room);
        cairo_clip(pen.cairo());
        pen.colour(colourOf(curve));
        asLine(curve) ? line(pen, f, curve) : dots(pen, f, curve);
        cairo_restore(pen.cairo());
    }
}

void legend(Pen& pen, const Frame& f) {
    pen.font(kText);
    double y = f.top + kText;
    const double x = f.right + 2.0 * kGap;
    for (const Curve& curve : f.chart.curves) {
        if (curve.label.empty()) continue;
        pen.colour(colourOf(curve));
        if (asLine(curve)) {
            pen.segment(x, y - 0.36 * kText, x + kSwatch, y - 0.36 * kText, 2.0, curve.mark == Mark::dashed);
        } else {
            pen.dot(x + 0.5 * kSwatch, y - 0.36 * kText, curve.mark == Mark::rings);
        }
        pen.colour(kInk);
        pen.text(x + kSwatch + kGap, y, 0.0, curve.label);
        y += kText + 0.9 * kGap;
    }
}

void draw(cairo_t* cairo, const Chart& chart) {
    Pen pen(cairo);
    const Frame frame = frameOf(pen, chart);
    axes(pen, frame);
    curves(pen, frame);
    legend(pen, frame);
}

cairo_status_t append(void* into, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(into)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

tl::unexpected<Error> notDrawn(cairo_status_t status) {
    return fail(Fault::unsupported,
                std::string("The chart could not be drawn: ") + cairo_status_to_string(status) + ".");
}

}  // namespace

Result<std::string> pngOf(const Chart& chart) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kWidth * kPixelsPerUnit),
                                                     static_cast<int>(kHeight * kPixelsPerUnit)),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_scale(context.get(), kPixelsPerUnit, kPixelsPerUnit);
    draw(context.get(), chart);
    std::string bytes;
    const cairo_status_t drawn = cairo_status(context.get());
    const cairo_status_t written =
        drawn == CAIRO_STATUS_SUCCESS ? cairo_surface_write_to_png_stream(surface.get(), append, &bytes) : drawn;
    if (written != CAIRO_STATUS_SUCCESS) return notDrawn(written);
    return bytes;
}

Result<std::string> svgOf(const Chart& chart) {
    std::string bytes;
    const Surface surface(cairo_svg_surface_create_for_stream(append, &bytes, kWidth, kHeight), cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    draw(context.get(), chart);
    const cairo_status_t drawn = cairo_status(context.get());
    cairo_surface_finish(surface.get());
    const cairo_status_t finished = drawn == CAIRO_STATUS_SUCCESS ? cairo_surface_status(surface.get()) : drawn;
    if (finished != CAIRO_STATUS_SUCCESS) return notDrawn(finished);
    return bytes;
}

Result<void> writeChart(const std::filesystem::path& path, const Chart& chart) {
    const std::string ending = path.extension().string();
    if (ending != ".png" && ending != ".svg") {
        return fail(Fault::outOfRange,
                    "A chart is written as .png or .svg; " + projects::spoken(path) + " ends in neither.");
    }
    const auto bytes = ending == ".png" ? pngOf(chart) : svgOf(chart);
    if (!bytes) return tl::unexpected(bytes.error());
    return projects::writeAtomically(path, *bytes);
}

}  // namespace ilf::app
