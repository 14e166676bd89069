// `optics`: the formulas themselves, over a file of cases, as tables or as charts, for checking against other programs.
#pragma once

#include <string>

namespace ilf::app {

struct OpticsEvalOptions {
    std::string path = "precise";  ///< precise, fast64 or fast32
    std::string in, out;           ///< CSV
};
/// Inputs w (or p and q), P, e, r, Pe, De, Da, x1 as columns of those names in any order (`tag` is carried over, others
/// are left out, lines with # too), hexadecimal or decimal. Writes the inputs' tag and w, every value under the golden
/// files' names in hexadecimal, `inf` where the formula has no finite value, and `status`.
int opticsEvalCommand(const OpticsEvalOptions& options);

struct OpticsTableOptions {
    std::string table;  ///< far-border, near-border, blur or scale
    bool json = false;
    bool csv = false;
};
/// The tables of the reference eye (60 D, 4 mm pupil, 20 mm from the lens, 1 arcmin, 10 D of accommodation).
int opticsTableCommand(const OpticsTableOptions& options);

struct OpticsPlotOptions {
    std::string chart;  ///< far-border, near-border, blur or scale
    std::string out;    ///< .png or .svg
};
/// The same as charts, like the paper's figures.
int opticsPlotCommand(const OpticsPlotOptions& options);

}  // namespace ilf::app
