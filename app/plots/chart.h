// A chart as a value: curves over two axes, with everything a reader needs to read it.
#pragma once

#include <string>
#include <vector>

namespace ilf::app {

struct ChartPoint {
    double x = 0.0, y = 0.0;  ///< y not finite: a gap in the line
    double spread = 0.0;      ///< half the length of an error bar; 0: none
    bool operator==(const ChartPoint&) const = default;
};

enum class Mark {
    line,
    dashed,
    dots,
    rings,  ///< as dots, hollow
};

struct Curve {
    std::string label;  ///< in the legend; empty: not there
    Mark mark = Mark::line;
    int colour = 0;  ///< of a palette that colour-blind readers can tell apart too; any number
    std::vector<ChartPoint> points;
    bool operator==(const Curve&) const = default;
};

/// What an axis shows; beyond it nothing is drawn.
struct ChartAxis {
    std::string title;  ///< with the unit
    double low = 0.0, high = 1.0;
    bool operator==(const ChartAxis&) const = default;
};

struct Chart {
    std::string title;
    std::string note;  ///< small, under the chart: assumptions, and whether it is simulated
    ChartAxis x, y;
    std::vector<Curve> curves;
    bool operator==(const Chart&) const = default;
};

/// Round numbers from `low` to `high` (both included where they are round), `about` of them, at a step of 1, 2 or 5
/// times a power of ten. Precondition: low < high, both finite, about >= 2.
std::vector<double> ticks(double low, double high, int about);
/// The ticks' text: as many decimals as the step between them needs.
std::vector<std::string> tickWords(const std::vector<double>& ticks);

/// `low`..`high` widened to ticks. Equal or not finite: a range of 1 about what there is.
ChartAxis axisOver(std::string title, double low, double high);

}  // namespace ilf::app
