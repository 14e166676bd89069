#include "tests/bench/perceived/scaling_rows.h"

#include <cmath>

#include "tests/bench/perceived/engine_rows.h"
#include "tests/bench/perceived/scenes.h"

namespace ilf::bench {
namespace {

class Scaling {
public:
    Scaling(Table& table, const Patience& patience, Rung rung) : table_(table), patience_(patience), rung_(rung) {}

    /// The row's least time, which what else runs disturbs least; nothing if the scene could not be made.
    double add(const std::string& family, const Result<BenchScene>& scene) {
        if (!scene) {
            std::fprintf(stderr, "%s: %s\n", family.c_str(), scene.error().what.c_str());
            failed = true;
            return kNothing;
        }
        const Shown& shown = scene->shown;
        Row row = engineRow(*scene, {edit::kFull, {shown, dimmed(shown), shown}}, rung_, 1, patience_);
        row.section = "scaling";
        row.what = family;
        const double least = row.times.least;
        table_.add(std::move(row));
        return least;
    }
    void conclude(const std::string& family, double figure, const std::string& unit) {
        Row row{.section = "scaling", .scene = "all", .method = std::string(word(rung_)), .what = family};
        row.threads = 1;
        row.figure = figure;
        row.unit = unit;
        table_.add(std::move(row));
    }
    bool failed = false;

private:
    Table& table_;
    Patience patience_;
    Rung rung_;
};

/// Slope of log time over log pixels, least squares.
double exponent(const std::vector<std::pair<double, double>>& points) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const auto& [pixels, ms] : points) {
        const double u = std::log(pixels), v = std::log(ms);
        n += 1.0, x += u, y += v, xx += u * u, xy += u * v;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

bool addScalingRows(Table& table, const Patience& patience) {
    bool good = true;
    for (const Rung rung : {Rung::dragging, Rung::rest}) {
        Scaling scaling(table, patience, rung);
        const double one = scaling.add("slots", splitLight(1));
        scaling.add("slots", splitLight(2));
        scaling.add("slots", splitLight(4));
        const double eight = scaling.add("slots", splitLight(8));
        scaling.conclude("slots", 100.0 * (eight / one - 1.0) / 7.0, "% per slot more");

        double at8 = kNothing, at40 = kNothing;
        for (const double radius : {8.0, 12.0, 20.0, 28.0, 40.0}) {
            const double ms = scaling.add("radius", oneRadius(radius));
            if (radius == 8.0) at8 = ms;
            at40 = ms;
        }
        scaling.conclude("radius", at40 / at8, "x from 8 to 40 px");

        double first = kNothing, last = kNothing;
        for (const int regions : {1, 2, 4, 8, 12}) {
            last = scaling.add("regions", manyRegions(regions));
            if (regions == 1) first = last;
        }
        scaling.conclude("regions", last / first, "x from 1 to 12");

        std::vector<std::pair<double, double>> points;
        for (const int width : {512, 768, 1024, 1536, 2048})
            points.emplace_back(0.75 * width * width, scaling.add("pixels", fourObjectsEye(width)));
        scaling.conclude("pixels", exponent(points), "exponent");
        good = good && !scaling.failed;
    }
    return good;
}

}  // namespace ilf::bench
