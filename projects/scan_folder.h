// A folder of a camera's pictures of Gray-code patterns: read as a scan, and written so that it can be decoded again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/registration/gray_code.h"

namespace ilf::projects {

/// OpenCV's order and that of kamino410's procam-calibration: columns from the most significant bit, each beside its
/// inverse, then rows, white and black last.
std::vector<Pattern> openCvPatterns(Size projector);

/// What scan.json says a picture shows: "white", "black", "column 3", "row 0 inverse", "marker 2".
std::string shown(const Pattern& pattern);
std::optional<Pattern> patternFromWords(const std::string& words);

/// Without a scan.json the folder's pictures, in the order of their names (2 before 10), show openCvPatterns. With one:
///
///     {"format": "illuminatedfocus-scan", "version": 1, "projector": [1024, 768],
///      "pictures": [{"file": "a.png", "shows": "white"}, {"file": "b.png", "shows": "column 0 inverse"}, ...]}
///
/// or, for names in order, "order": "white-first" (grayCodePatterns) or "white-last" (openCvPatterns) instead of
/// "pictures". `projector` given here wins; 1024 x 768 if nothing says it. Colour pictures are turned to grey.
/// Refused with a sentence: no folder, no or the wrong number of pictures, a picture that is missing, damaged or of
/// another size than the first, words that name no pattern.
Result<Scan> readScan(const std::filesystem::path& folder, std::optional<Size> projector = std::nullopt);

/// Pictures as PNG and their scan.json, in a folder that must not exist yet.
Result<void> writeScan(const std::filesystem::path& folder, const Scan& scan);

}  // namespace ilf::projects
