#include "projects/wave_csv_text.h"

#include <charconv>
#include <cmath>
#include <optional>

namespace ilf::projects {
namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Finite only. Independent of the locale.
std::optional<double> number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

constexpr std::size_t kMostSamples = 100000;

}  // namespace

std::vector<std::string> csvCells(std::string_view line) {
    std::vector<std::string> cells;
    for (std::size_t start = 0;;) {
        const std::size_t comma = line.find(',', start);
        cells.emplace_back(trimmed(line.substr(start, comma - start)));
        if (comma == std::string_view::npos) return cells;
        start = comma + 1;
    }
}

Result<CsvWave> CsvWave::of(std::string_view text, const std::string& spokenName,
                            const std::map<std::string, std::string>& others) {
    CsvWave wave;
    wave.name_ = spokenName;
    bool columns = false;
    int line = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view content = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line;
        if (content.empty()) continue;
        if (content.starts_with('#')) {
            const std::size_t equals = content.find('=');
            if (equals == std::string_view::npos) continue;  // a remark
            const std::string key(trimmed(content.substr(1, equals - 1)));
            if (!wave.keys_.try_emplace(key, Value{std::string(trimmed(content.substr(equals + 1))), line}).second) {
                return wave.wrong(line, "\"" + key + "\" is given a second time; keep one.");
            }
            continue;
        }
        const auto cells = csvCells(content);
        if (!columns) {
            if (cells != std::vector<std::string>{"t_s", "u", "P_D"}) {
                return wave.wrong(line, "the columns must be t_s,u,P_D, not \"" + std::string(content) + "\".");
            }
            columns = true;
            continue;
        }
        if (cells.size() != 3) {
            return wave.wrong(line, "a sample has three values, t_s,u,P_D; this one has " +
                                        std::to_string(cells.size()) + ".");
        }
        std::vector<double>* const into[] = {&wave.time_s, &wave.drive, &wave.power_D};
        const char* const names[] = {"t_s", "u", "P_D"};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = projects::number(cells[i]);
            if (!value) {
                return wave.wrong(line, std::string(names[i]) + " is no finite number: \"" + cells[i] +
                                            "\"; remove the sample or record the wave again.");
            }
            into[i]->push_back(*value);
        }
        wave.lines.push_back(line);
        if (wave.lines.size() > kMostSamples) return wave.wrong(line, "more than 100000 samples are not one period.");
    }
    if (!columns) return wave.wrong("has no samples; after the header must come t_s,u,P_D and one period.");
    for (const auto& [key, value] : others)
        wave.keys_.try_emplace(key, Value{value, 0});
    return wave;
}

tl::unexpected<Error> CsvWave::wrong(const std::string& what) const { return fail(Fault::badFile, name_ + " " + what); }
tl::unexpected<Error> CsvWave::wrong(int line, const std::string& what) const {
    return fail(Fault::badFile, name_ + ", line " + std::to_string(line) + ": " + what);
}
tl::unexpected<Error> CsvWave::wrong(const std::string& key, const std::string& what) const {
    const auto at = keys_.find(key);
    if (at == keys_.end() || at->second.line == 0) return wrong(": " + key + " " + what);
    return wrong(at->second.line, key + " " + what);
}

Result<std::string> CsvWave::text(const std::string& key) const {
    const auto at = keys_.find(key);
    if (at == keys_.end()) return wrong("lacks the line \"# " + key + "=...\" in its header.");
    return at->second.text;
}
std::string CsvWave::text(const std::string& key, const std::string& otherwise) const {
    const auto at = keys_.find(key);
    return at == keys_.end() ? otherwise : at->second.text;
}

Result<double> CsvWave::number(const std::string& key) const {
    const auto found = text(key);
    if (!found) return tl::unexpected(found.error());
    const auto value = projects::number(*found);
    if (!value) return wrong(key, "is no finite number: \"" + *found + "\".");
    return *value;
}
Result<double> CsvWave::number(const std::string& key, double otherwise) const {
    return has(key) ? number(key) : Result<double>(otherwise);
}

Result<std::vector<double>> CsvWave::numbers(const std::string& key) const {
    std::vector<double> values;
    const std::string all = text(key, "");
    for (std::string_view rest = trimmed(all); !rest.empty();) {
        const std::size_t blank = rest.find(' ');
        const auto value = projects::number(rest.substr(0, blank));
        if (!value) return wrong(key, "must be numbers separated by blanks, not \"" + all + "\".");
        values.push_back(*value);
        rest = blank == std::string_view::npos ? std::string_view() : trimmed(rest.substr(blank));
    }
    return values;
}

}  // namespace ilf::projects
