#include "app/headless/optics_command.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/plots/draw.h"
#include "app/plots/optics_charts.h"
#include "core/base/as_text.h"
#include "core/optics/eye.h"
#include "core/optics/kernel.h"

namespace ilf::app {
namespace {

std::vector<std::string> cells(std::string line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> out;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');)
        out.push_back(cell);
    if (!line.empty() && line.back() == ',') out.emplace_back();
    return out;
}

std::optional<double> number(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    while (end != nullptr && *end == ' ')
        ++end;
    if (text.empty() || end == nullptr || *end != '\0') return std::nullopt;
    return value;
}

std::string hexadecimal(double value) {
    if (std::isinf(value)) return value < 0.0 ? "-inf" : "inf";
    char text[40];
    std::snprintf(text, sizeof text, "%a", value);
    return text;
}

std::optional<OpticsPath> pathNamed(const std::string& name) {
    if (name == "precise") return OpticsPath::precise;
    if (name == "fast64") return OpticsPath::fast64;
    if (name == "fast32") return OpticsPath::fast32;
    return std::nullopt;
}

/// Which input each column of the file is; columns of other names are passed over.
class Columns {
public:
    static Result<Columns> of(const std::vector<std::string>& names, const std::string& file) {
        Columns columns;
        for (std::size_t i = 0; i < names.size(); ++i)
            columns.at_[names[i]] = i;
        const bool projective = columns.at_.contains("p") && columns.at_.contains("q");
        if (!projective) columns.needed_ = {"w", "P", "e", "r", "Pe", "De", "Da", "x1"};
        for (const std::string& name : columns.needed_) {
            if (columns.at_.contains(name)) continue;
            return fail(Fault::badFile,
                        "\"" + file + "\" has no column \"" + name +
                            "\". Its first line must name the columns w (or p and q), P, e, r, Pe, De, Da "
                            "and x1.");
        }
        return columns;
    }

    Result<OpticsCase> read(const std::vector<std::string>& row, const std::string& place) const {
        std::map<std::string, double> value;
        for (const std::string& name : needed_) {
            const std::size_t i = at_.at(name);
            const auto parsed = i < row.size() ? number(row[i]) : std::nullopt;
            if (!parsed) {
                return fail(Fault::badFile, place + ": " + name + " is not a number: \"" +
                                                (i < row.size() ? row[i] : "") +
                                                "\". Give hexadecimal floats such as 0x1.8p+1, or decimal ones.");
            }
            value[name] = *parsed;
        }
        OpticsCase in;
        if (value.contains("w")) {
            in.setDistance(value["w"]);
        } else {
            in.p = value["p"];
            in.q = value["q"];
        }
        in.power = value["P"];
        in.lensToPupil = value["e"];
        in.retina = value["r"];
        in.eyePower = value["Pe"];
        in.pupil = value["De"];
        in.confusion = value["Da"];
        in.height = value["x1"];
        return in;
    }

    std::string tag(const std::vector<std::string>& row) const {
        const auto at = at_.find("tag");
        return at != at_.end() && at->second < row.size() ? row[at->second] : "";
    }

private:
    std::map<std::string, std::size_t> at_;
    std::vector<std::string> needed_ = {"p", "q", "P", "e", "r", "Pe", "De", "Da", "x1"};
};

Result<std::size_t> evaluated(const OpticsEvalOptions& options, OpticsPath path, std::string& out) {
    std::ifstream file(options.in);
    if (!file) return fail(Fault::notFound, "cannot read \"" + options.in + "\". Check the path.");
    std::optional<Columns> columns;
    std::size_t rows = 0, number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        if (line.empty() || line[0] == '#' || line == "\r") continue;
        const auto row = cells(line);
        if (!columns) {
            auto named = Columns::of(row, options.in);
            if (!named) return tl::unexpected(named.error());
            columns = std::move(*named);
            out += "tag,w";
            for (std::size_t i = 0; i < kOptics; ++i)
                out += "," + std::string(word(static_cast<Optic>(i)));
            out += ",status\n";
            continue;
        }
        const auto in = columns->read(row, options.in + ", line " + std::to_string(number));
        if (!in) return tl::unexpected(in.error());
        const OpticsValues values = evaluate(*in, path);
        out += columns->tag(row) + "," + hexadecimal(in->q == 0.0 ? HUGE_VAL : in->p / in->q);
        for (const double value : values.values)
            out += "," + hexadecimal(value);
        out += "," + std::string(word(values.status)) + "\n";
        ++rows;
    }
    if (!columns) return fail(Fault::badFile, "\"" + options.in + "\" is empty. Its first line must name the columns.");
    return rows;
}

struct Table {
    std::vector<std::string> names;
    std::vector<std::vector<double>> rows;
};

/// The reference eye; `near` is the eye accommodating as much as it can.
OpticsCase referenceEye(double distance, double power, bool near = false) {
    OpticsCase in;
    in.setDistance(distance);
    in.power = power;
    in.lensToPupil = 0.020;
    in.retina = 1.0 / 60.0;
    in.eyePower = near ? 70.0 : 60.0;
    in.pupil = 0.004;
    in.confusion = 4.848136811095360e-6;  // 1 arcmin
    in.height = 0.050;
    return in;
}

std::optional<Table> table(const std::string& name) {
    Table out;
    constexpr double kDistances_mm[] = {250, 500, 750, 1000, 1250, 1300, 1500, 1750, 2000, 2250, 2500};
    if (name == "far-border") {
        out.names = {"d_oE_mm", "P_E_D"};
        for (const double d : kDistances_mm)
            out.rows.push_back({d, evaluate(referenceEye(d / 1e3, 0.0), OpticsPath::precise)[Optic::pMinFar]});
        return out;
    }
    if (name == "near-border") {
        out.names = {"P_E_D", "near_border_mm", "far_border_mm"};
        for (int i = 0; i <= 20; ++i) {
            const double power = 0.25 * i;
            const double near = evaluate(referenceEye(1.0, power, true), OpticsPath::precise)[Optic::wNear];
            const double far = evaluate(referenceEye(1.0, power), OpticsPath::precise)[Optic::wFar];
            // A negative far border is none: sharp to infinity and beyond.
            out.rows.push_back({power, 1e3 * near, far > 0.0 ? 1e3 * far : HUGE_VAL});
        }
        return out;
    }
    const bool blur = name == "blur";
    if (!blur && name != "scale") return std::nullopt;
    out.names = blur ? std::vector<std::string>{"d_oE_mm", "P_E_D", "E_D", "D_r_um", "beta_arcmin"}
                     : std::vector<std::string>{"d_oE_mm", "P_E_D", "s", "s_minus_1", "seam_mm_at_50mm"};
    for (const double d : kDistances_mm) {
        for (int i = 0; i <= 10; ++i) {
            const double power = 0.5 * i;
            const OpticsCase in = referenceEye(d / 1e3, power);
            const OpticsValues v = evaluate(in, OpticsPath::precise);
            if (blur) {
                const double arcmin = in.pupil * std::abs(v[Optic::E]) / kArcmin;
                out.rows.push_back({d, power, v[Optic::E], 1e6 * v[Optic::Dr], arcmin});
            } else {
                out.rows.push_back({d, power, v[Optic::s], v[Optic::sMinus1], 50.0 * v[Optic::sMinus1]});
            }
        }
    }
    return out;
}

void print(const Table& table, const OpticsTableOptions& options) {
    if (options.json) {
        std::cout << "[";
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
            std::cout << (i == 0 ? "\n {" : ",\n {");
            for (std::size_t k = 0; k < table.names.size(); ++k) {
                const double value = table.rows[i][k];
                std::cout << (k == 0 ? "\"" : ", \"") << table.names[k]
                          << "\": " << (std::isfinite(value) ? asText("%.17g", value) : "null");
            }
            std::cout << "}";
        }
        std::cout << "\n]\n";
        return;
    }
    const auto line = [&](const auto& row, auto&& text) {
        for (std::size_t k = 0; k < row.size(); ++k)
            std::cout << (k > 0 && options.csv ? "," : "") << text(row[k]);
        std::cout << '\n';
    };
    const auto padded = [&](std::string text) {
        if (!options.csv) text.insert(0, std::max<std::size_t>(18, text.size() + 1) - text.size(), ' ');
        return text;
    };
    line(table.names, padded);
    for (const auto& row : table.rows)
        line(row, [&](double value) { return padded(asText(options.csv ? "%.17g" : "%.10g", value)); });
}

}  // namespace

int opticsEvalCommand(const OpticsEvalOptions& options) {
    const auto path = pathNamed(options.path);
    if (!path) {
        return refused("optics eval", {Fault::outOfRange,
                                       "There is no path \"" + options.path + "\". Choose precise, fast64 or fast32."});
    }
    std::string text;
    const auto rows = evaluated(options, *path, text);
    if (!rows) return refused("optics eval", rows.error());
    std::ofstream out(options.out, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        return refused("optics eval", {Fault::cannotWrite,
                                       "cannot write \"" + options.out + "\". Check the folder and the space left."});
    }
    std::cout << options.out << ": " << *rows << " cases, " << options.path << '\n';
    return kDone;
}

int opticsTableCommand(const OpticsTableOptions& options) {
    const auto found = table(options.table);
    if (!found) {
        return refused("optics table", {Fault::outOfRange, "There is no table \"" + options.table +
                                                               "\". Choose far-border, near-border, blur or scale."});
    }
    print(*found, options);
    return kDone;
}

int opticsPlotCommand(const OpticsPlotOptions& options) {
    const auto chart = opticsChart(options.chart);
    if (!chart) {
        return refused("optics plot", {Fault::outOfRange, "There is no chart \"" + options.chart +
                                                              "\". Choose far-border, near-border, blur or scale."});
    }
    if (const auto written = writeChart(options.out, *chart); !written) return refused("optics plot", written.error());
    std::cout << options.out << ": " << chart->title << '\n';
    return kDone;
}

}  // namespace ilf::app
