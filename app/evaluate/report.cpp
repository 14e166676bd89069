#include "app/evaluate/report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/plots/draw.h"
#include "core/base/as_text.h"
#include "projects/json.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::app {
namespace {

std::string row(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells)
        text += " " + cell + " |";
    return text + "\n";
}

std::string heading(const std::vector<std::string>& cells) {
    return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
}

std::string sizesTable(const BlurSizes& sizes) {
    std::string text =
        heading({"distance [mm]", "power [D]", "model", "fixed, middle", "fixed", "exact sine", "paper's wave"});
    for (const BlurCase& c : sizes.cases) {
        text += row({asText("%.0f", c.distance_mm), asText("%.1f", c.power_D), asText("%.2f", c.model_px),
                     asText("%.2f", c.middle_px), asText("%.2f", c.fixed_px), asText("%.2f", c.sine_px),
                     asText("%.2f", c.wave_px)});
    }
    return text;
}

std::string rangeTable(const BlurRange& range) {
    std::string text = heading({"distance [mm]", "1/distance [D]", "0.2 D steps [D]", "bisection [D]"});
    for (const BorderCase& c : range.cases) {
        text += row({asText("%.0f", c.distance_mm), asText("%.3f", 1e3 / c.distance_mm),
                     asText("%.2f", c.steps_D.mean) + " +- " + asText("%.2f", c.steps_D.spread),
                     asText("%.3f", c.border_D.mean) + " +- " + asText("%.3f", c.border_D.spread)});
    }
    return text;
}

std::string objectsTable(const std::vector<FourObjects>& conditions) {
    std::string text = heading({"condition", "object", "distance [mm]", "asked", "detail left", "seen"});
    for (const FourObjects& one : conditions) {
        for (const ObjectSeen& object : one.objects) {
            text +=
                row({one.condition, object.name, asText("%.0f", object.distance_mm), object.toBlur ? "blur" : "focus",
                     asText("%.0f %%", 100.0 * object.detail), object.blurred ? "blurred" : "sharp"});
        }
    }
    return text;
}

std::string seamsTable(const std::vector<SeamCase>& seams) {
    std::string text = heading({"texture", "blurred side", "power [D]", "hard masks", "paper's ramps", "closed form"});
    for (const SeamCase& one : seams) {
        text += row({one.texture, one.blurredInside ? "inner (overlap)" : "outer (gap)", asText("%.0f", one.power_D),
                     asText("%+.2f", one.before), asText("%+.2f", one.paper), asText("%+.2f", one.after)});
    }
    return text;
}

/// Pictures of one size beside each other, in rows of `columns`, white lines between them.
Image<std::uint8_t> montage(const std::vector<Image<std::uint8_t>>& pictures, int columns) {
    constexpr int kLine = 6;
    const Size one = pictures.front().size();
    const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    const Size size{columns * (one.width + kLine) - kLine, rows * (one.height + kLine) - kLine};
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width * size.height * 3), 255);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const int left = static_cast<int>(i) % columns * (one.width + kLine);
        const int top = static_cast<int>(i) / columns * (one.height + kLine);
        for (int y = 0; y < one.height; ++y)
            std::copy_n(pictures[i].row(y), pictures[i].stride(), pixels.data() + 3 * ((top + y) * size.width + left));
    }
    return {size, 3, std::move(pixels)};
}

std::string fileOf(const std::string& texture) {
    std::string name = "seams-" + texture + ".png";
    std::ranges::replace(name, ' ', '-');
    return name;
}

/// Before, the paper's ramps and the closed form beside each other, a case a row.
std::map<std::string, Image<std::uint8_t>> seamPictures(const std::vector<SeamCase>& seams) {
    std::map<std::string, std::vector<Image<std::uint8_t>>> byTexture;
    for (const SeamCase& one : seams) {
        auto& pictures = byTexture[one.texture];
        pictures.insert(pictures.end(), {one.beforePicture, one.paperPicture, one.afterPicture});
    }
    std::map<std::string, Image<std::uint8_t>> out;
    for (const auto& [texture, pictures] : byTexture)
        out[fileOf(texture)] = montage(pictures, 3);
    return out;
}

}  // namespace

Chart blurSizeChart(const BlurSizes& sizes) {
    Chart chart{"Blur circle of a camera behind the lens",
                "Simulated: 24 mm F1.4, 8.4 um pixels, 20 mm behind a lens 16 mm wide, focused on the dots at 0 D "
                "(assumed); all distances.",
                {"Lens power P_E [D]", 0.0, 5.0},
                {"Radius [px]", 0.0, 120.0},
                {}};
    Curve model{"model, 500 mm", Mark::line, 6, {}}, middle{"fixed, middle circle", Mark::dots, 0, {}},
        fixed{"fixed, mean of nine", Mark::dots, 1, {}}, swept{"swept, mean of nine", Mark::rings, 2, {}};
    for (const BlurCase& c : sizes.cases) {
        middle.points.push_back({c.power_D, c.middle_px});
        fixed.points.push_back({c.power_D, c.fixed_px});
        swept.points.push_back({c.power_D, c.wave_px});
        if (c.distance_mm == sizes.cases.front().distance_mm) model.points.push_back({c.power_D, c.model_px});
    }
    // The distances lie on top of each other: they differ by less than half a pixel.
    chart.curves = {std::move(model), std::move(middle), std::move(fixed), std::move(swept)};
    return chart;
}

Chart blurDifferenceChart(const BlurSizes& sizes) {
    Chart chart{"Swept less fixed lens",
                "Simulated. Paper: 1.4 +- 1.8 px over all cases. Rings: exact sine; dots: the paper's rule on 2485 "
                "waves of the emulated lens.",
                {"Lens power P_E [D]", 0.0, 5.5},
                {},
                {}};
    std::map<double, Curve> sine, wave;
    double low = 0.0, high = 0.0;
    for (const BlurCase& c : sizes.cases) {
        if (c.power_D == 0.0) continue;
        sine[c.distance_mm].points.push_back({c.power_D, c.sine_px - c.fixed_px});
        wave[c.distance_mm].points.push_back({c.power_D, c.wave_px - c.fixed_px});
        low = std::min({low, c.sine_px - c.fixed_px, c.wave_px - c.fixed_px});
        high = std::max({high, c.sine_px - c.fixed_px, c.wave_px - c.fixed_px});
    }
    chart.y = axisOver("Difference of radius [px]", low, std::max(high, 1.5));
    chart.curves.push_back({"paper's mean", Mark::dashed, 6, {{0.0, 1.4}, {5.5, 1.4}}});
    int colour = 0;
    for (auto& [distance, curve] : wave) {
        curve.label = asText("%.0f mm, wave", distance);
        curve.mark = Mark::dots;
        Curve& other = sine[distance];
        other.label = asText("%.0f mm, sine", distance);
        other.mark = Mark::rings;
        curve.colour = other.colour = colour++;
        chart.curves.push_back(curve);
        chart.curves.push_back(other);
    }
    return chart;
}

Chart blurRangeChart(const BlurRange& range) {
    Chart chart{"Far border of ring readers",
                "Simulated: " + std::to_string(range.observers) +
                    " readers, pupils 3.3 to 4.7 mm, noise assumed. Bars: standard deviation.",
                {"Distance from the lens [mm]", 0.0, 2600.0},
                {"Lens power P_E [D]", 0.0, 2.6},
                {}};
    const auto model = [](const char* label, Mark mark, int colour, double offset) {
        Curve curve{label, mark, colour, {}};
        for (double mm = 380.0; mm <= 2600.0; mm += 10.0)
            curve.points.push_back({mm, 1e3 / mm + offset});
        return curve;
    };
    chart.curves.push_back(model("model, 1 arcmin", Mark::line, 6, 0.0726));
    chart.curves.push_back(model("model, Landolt", Mark::dashed, 6, 0.3817));
    Curve border{"bisection", Mark::dots, 0, {}}, steps{"0.2 D steps (paper)", Mark::rings, 1, {}};
    for (const BorderCase& c : range.cases) {
        border.points.push_back({c.distance_mm, c.border_D.mean, c.border_D.spread});
        steps.points.push_back({c.distance_mm, c.steps_D.mean, c.steps_D.spread});
    }
    chart.curves.push_back(std::move(border));
    chart.curves.push_back(std::move(steps));
    return chart;
}

std::string markdown(const Evaluation& evaluation) {
    std::string text =
        "# Evaluation (simulated)\n\n"
        "Section 5 of Ueda et al. 2020 repeated on the simulated system. Pictures come from rays traced "
        "through lens and pupil; circles, rings, detail and seams are measured in them by observers that "
        "know none of the formulas. No lens, projector or person was measured.\n\n";
    text += heading({"what", "ours", "paper", "remark"});
    for (const Finding& one : findings(evaluation))
        text += row({one.what, one.ours, one.paper, one.remark});
    text +=
        "\n## Blur circles\n\nRadius in pixels. *model*: closed form with the lens as stop; *middle*: the circle on "
        "the axis; the others: mean of nine circles.\n\n![radius](blur-size.png)\n![difference]"
        "(blur-difference.png)\n![dots, swept lens](dots.png)\n\n" +
        sizesTable(evaluation.sizes);
    text += "\n## Blur range\n\nSix rings of one arcmin, four directions, more than three must be read; lens held. "
            "Paper: 8 participants, values only plotted.\n\n![far border](blur-range.png)\n\n" +
            rangeTable(evaluation.range);
    text += "\n## Four objects\n\nEach is looked at in turn; less than half of its fine detail left counts as blurred. "
            "Pictures: looking at the first sharp object; A to D from left to right.\n\n";
    for (std::size_t i = 0; i < evaluation.objects.size(); ++i)
        text += "![" + evaluation.objects[i].condition + "](objects-" + std::to_string(i + 1) + ".png)\n";
    text += "\n" + objectsTable(evaluation.objects);
    text +=
        "\n## Seams\n\nLargest Weber contrast within 10 mm of the border, 50 mm from the optical centre, at 500 mm; "
        "positive is bright. Pictures: hard masks, paper's ramps, closed form; rows as in the table.\n\n";
    for (const auto& [file, picture] : seamPictures(evaluation.seams))
        text += "![" + file + "](" + file + ")\n";
    return text + "\n" + seamsTable(evaluation.seams);
}

std::string json(const Evaluation& evaluation) {
    using projects::Json;
    const auto spread = [](const MeanSpread& value) {
        Json out;
        out.set("mean", value.mean);
        out.set("sd", value.spread);
        return out;
    };
    Json report;
    report.set("simulated", true);
    std::vector<Json> list;
    for (const Finding& one : findings(evaluation)) {
        Json out;
        out.set("what", one.what);
        out.set("ours", one.ours);
        out.set("paper", one.paper);
        out.set("remark", one.remark);
        list.push_back(std::move(out));
    }
    report.set("findings", list);
    list.clear();
    for (const BlurCase& c : evaluation.sizes.cases) {
        Json out;
        out.set("distance_mm", c.distance_mm);
        out.set("power_D", c.power_D);
        out.set("model_px", c.model_px);
        out.set("fixed_middle_px", c.middle_px);
        out.set("fixed_px", c.fixed_px);
        out.set("sine_px", c.sine_px);
        out.set("wave_px", c.wave_px);
        list.push_back(std::move(out));
    }
    report.set("blur_circles", list);
    report.set("sine_less_fixed_px", spread(evaluation.sizes.sine));
    report.set("wave_less_fixed_px", spread(evaluation.sizes.wave));
    list.clear();
    for (const BorderCase& c : evaluation.range.cases) {
        Json out;
        out.set("distance_mm", c.distance_mm);
        out.set("steps_D", spread(c.steps_D));
        out.set("border_D", spread(c.border_D));
        list.push_back(std::move(out));
    }
    report.set("blur_range", list);
    list.clear();
    for (const FourObjects& condition : evaluation.objects) {
        for (const ObjectSeen& object : condition.objects) {
            Json out;
            out.set("condition", condition.condition);
            out.set("pS_D", condition.pS_D);
            out.set("object", object.name);
            out.set("distance_mm", object.distance_mm);
            out.set("to_blur", object.toBlur);
            out.set("detail", object.detail);
            out.set("blurred", object.blurred);
            list.push_back(std::move(out));
        }
    }
    report.set("four_objects", list);
    list.clear();
    for (const SeamCase& one : evaluation.seams) {
        Json out;
        out.set("texture", one.texture);
        out.set("blurred_side", std::string(one.blurredInside ? "inner" : "outer"));
        out.set("power_D", one.power_D);
        out.set("weber_hard", one.before);
        out.set("weber_paper", one.paper);
        out.set("weber_closed_form", one.after);
        list.push_back(std::move(out));
    }
    report.set("seams", list);
    return report.text();
}

Result<void> writeReport(const std::filesystem::path& folder, const Evaluation& evaluation) {
    Result<void> done = projects::makeFolders(folder);
    const auto then = [&](auto&& write) {
        if (done) done = write();
    };
    const auto picture = [&](const std::string& name, const Image<std::uint8_t>& image) {
        then([&] { return projects::writePng(folder / name, image); });
    };
    then([&] { return writeChart(folder / "blur-size.png", blurSizeChart(evaluation.sizes)); });
    then([&] { return writeChart(folder / "blur-difference.png", blurDifferenceChart(evaluation.sizes)); });
    then([&] { return writeChart(folder / "blur-range.png", blurRangeChart(evaluation.range)); });
    picture("dots.png", evaluation.sizes.picture);
    for (std::size_t i = 0; i < evaluation.objects.size(); ++i)
        picture("objects-" + std::to_string(i + 1) + ".png", evaluation.objects[i].picture);
    for (const auto& [file, image] : seamPictures(evaluation.seams))
        picture(file, image);
    then([&] { return projects::writeAtomically(folder / "report.json", json(evaluation)); });
    then([&] { return projects::writeAtomically(folder / "report.md", markdown(evaluation)); });
    return done;
}

}  // namespace ilf::app
