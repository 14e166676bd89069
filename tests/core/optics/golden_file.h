// Rows of the reference's golden files: inputs, exact results rounded once, and distances between the two in ulp.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <istream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/optics/kernel.h"

namespace ilf {

struct GoldenRow {
    std::string tag;
    OpticsCase in;
    double w = 0.0;
    double blurScale = 0.0;  ///< D_e max(|1 - r P_e|, |r t / N|), metres
    std::map<std::string, double> out;

    double expected(Optic optic) const { return out.at(std::string(word(optic))); }
    double error(Optic optic, double got, int digits = std::numeric_limits<double>::digits) const;
};

/// |got - want| in units in the last place of want, for numbers of `digits` bits.
inline double ulps(double got, double want, int digits = std::numeric_limits<double>::digits) {
    if (got == want) return 0.0;
    if (!std::isfinite(got) || want == 0.0) return std::numeric_limits<double>::infinity();
    int exponent = 0;
    std::frexp(want, &exponent);
    return std::ldexp(std::abs(got - want), digits - exponent);
}

inline double GoldenRow::error(Optic optic, double got, int digits) const { return ulps(got, expected(optic), digits); }

/// Lines starting with # are skipped; the first other line names the columns.
inline std::vector<GoldenRow> goldenRows(std::istream& text) {
    const auto cells = [](const std::string& line) {
        std::vector<std::string> out;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');)
            out.push_back(cell);
        return out;
    };
    std::vector<std::string> names;
    std::vector<GoldenRow> rows;
    for (std::string line; std::getline(text, line);) {
        if (line.empty() || line[0] == '#') continue;
        if (names.empty()) {
            names = cells(line);
            continue;
        }
        const auto values = cells(line);
        GoldenRow row;
        row.tag = values.at(0);
        for (std::size_t i = 1; i < names.size(); ++i)
            row.out[names[i]] = std::strtod(values.at(i).c_str(), nullptr);
        row.w = row.out.at("w");
        row.in.setDistance(row.w);
        row.in.power = row.out.at("P");
        row.in.lensToPupil = row.out.at("e");
        row.in.retina = row.out.at("r");
        row.in.eyePower = row.out.at("Pe");
        row.in.pupil = row.out.at("De");
        row.in.confusion = row.out.at("Da");
        row.in.height = row.out.at("x1");
        row.blurScale = row.out.at("Dr_scale");
        rows.push_back(std::move(row));
    }
    return rows;
}

/// What the precise path promises, in ulp.
inline double preciseBound(Optic optic, const std::string& tag) {
    switch (optic) {
    case Optic::uE:
        return 2.0;
    case Optic::duE:
        return 3.0;
    case Optic::xFar:
    case Optic::xNear:
        return tag == "border_pole" ? 8.0 : 4.0;
    case Optic::wFar:
    case Optic::wNear:
        return tag == "border_pole" ? 8.0 : 1.0;
    default:
        return 1.0;
    }
}

}  // namespace ilf
