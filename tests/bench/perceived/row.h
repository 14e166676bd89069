// One line of the benchmark's table: what was done, how long it took, how wrong the picture is.
#pragma once

#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace ilf::bench {

inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();  ///< an empty cell

/// More than this many processors taken by other programs: a row is not to be trusted.
inline constexpr double kContended = 0.15;

/// Times of one call, milliseconds of the clock on the wall.
struct Times {
    double p50 = kNothing, p95 = kNothing, least = kNothing;
    int repetitions = 0;
    double own = 0.0;     ///< processors this program used meanwhile
    double others = 0.0;  ///< processors that other programs used meanwhile
};

/// Against the reference: dB for peak 1, on random pixels; the band lies within the largest blur of a border.
struct Errors {
    double psnr = kNothing, band = kNothing, worst = kNothing;
    /// dB that the reference's own noise would give, everywhere and in the band: nothing above them - 3 dB is known.
    double floor = kNothing, bandFloor = kNothing;
};

struct Row {
    std::string section{};  ///< machine, plane, scene, baseline, scaling
    std::string scene{}, method{}, what{};
    int threads = 0;
    Times times{};
    Errors errors{};
    double figure = kNothing;  ///< what is not a time: GFLOP/s, GB/s, an exponent, a ratio; `unit` says which
    std::string unit{};
    double ratio = kNothing;      ///< baseline's p50 over this one's, same run
    double ofFma = kNothing;      ///< share of the time that its exact perimeter sums take at the machine's FMA peak
    double ofMemory = kNothing;   ///< share of the time that the least bytes take at the machine's bandwidth
    double geometry = kNothing;   ///< ViewCounters::geometry_ms, p50
    int tiles = 0, computed = 0;  ///< of the view's tiles
    std::string note{};
};

/// Errors smaller than twice the reference's own are not known.
inline constexpr double kAboveFloor = 3.0;
inline bool drowned(double decibel, double floor) { return decibel > floor - kAboveFloor; }

/// Prints each row as it is made, and keeps them.
class Table {
public:
    Row& add(Row row);
    const std::vector<Row>& rows() const { return rows_; }
    const Row* find(const std::string& section, const std::string& scene, const std::string& method,
                    const std::string& what, int threads) const;
    /// False if it cannot be written.
    bool write(const std::string& path) const;

private:
    std::vector<Row> rows_;
};

}  // namespace ilf::bench
