// One wave's CSV file taken apart: header keys and columns, with the line each came from.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace ilf::projects {

/// Splits at commas, trims blanks, leaves out a carriage return at the end.
std::vector<std::string> csvCells(std::string_view line);

class CsvWave {
public:
    /// `others` are keys of the manifest; the file's own go first.
    static Result<CsvWave> of(std::string_view text, const std::string& spokenName,
                              const std::map<std::string, std::string>& others);

    bool has(const std::string& key) const { return keys_.contains(key); }
    /// Refused when missing.
    Result<std::string> text(const std::string& key) const;
    std::string text(const std::string& key, const std::string& otherwise) const;
    /// Refused when missing or not a finite number.
    Result<double> number(const std::string& key) const;
    Result<double> number(const std::string& key, double otherwise) const;
    /// Numbers separated by blanks.
    Result<std::vector<double>> numbers(const std::string& key) const;

    std::vector<double> time_s, drive, power_D;
    std::vector<int> lines;  ///< of each sample

    tl::unexpected<Error> wrong(const std::string& what) const;
    tl::unexpected<Error> wrong(int line, const std::string& what) const;
    /// At the line of a key, or of the file where the key came from the manifest.
    tl::unexpected<Error> wrong(const std::string& key, const std::string& what) const;

private:
    struct Value {
        std::string text;
        int line = 0;  ///< 0: the manifest's
    };
    std::string name_;
    std::map<std::string, Value> keys_;
};

}  // namespace ilf::projects
