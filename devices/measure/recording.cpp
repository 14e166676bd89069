#include "devices/measure/recording.h"

#include <sndfile.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace ilf::devices {
namespace {

constexpr std::size_t kFewest = 64;
constexpr std::int64_t kMost = 100'000'000;

tl::unexpected<Error> bad(const std::filesystem::path& path, const std::string& why) {
    return fail(Fault::badFile, "\"" + path.string() + "\" " + why);
}

struct Closed {
    void operator()(SNDFILE* file) const { sf_close(file); }
};

/// None: no sound file.
std::optional<Result<Recording>> soundIn(const std::filesystem::path& path) {
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, Closed> file(sf_open(path.c_str(), SFM_READ, &info));
    if (!file) return std::nullopt;
    if (info.channels < 1 || info.channels > 2)
        return bad(path, "has " + std::to_string(info.channels) +
                             " channels; record the light alone, or the trigger and the light.");
    if (info.frames > kMost || info.samplerate < 1) return bad(path, "is too long; a minute is plenty.");
    const auto channels = static_cast<std::size_t>(info.channels);
    Recording recording;
    recording.samplesPerSecond = info.samplerate;
    std::vector<double> block(4096 * channels);
    for (;;) {
        const sf_count_t frames = sf_readf_double(file.get(), block.data(), 4096);
        if (frames <= 0) break;
        for (std::size_t i = 0; i < static_cast<std::size_t>(frames); ++i) {
            if (channels == 2) recording.trigger.push_back(block[2 * i]);
            recording.light.push_back(block[channels * i + channels - 1]);
        }
    }
    if (sf_error(file.get()) != SF_ERR_NO_ERROR) return bad(path, "is damaged: its sound ends too early.");
    return recording;
}

/// The numbers of a line; empty when its first cell is none.
std::vector<double> numbersIn(std::string_view line) {
    std::vector<double> numbers;
    while (!line.empty() && line.find_first_not_of(",;\t \r") != std::string_view::npos) {
        const std::size_t end = std::min(line.find_first_of(",;\t"), line.size());
        std::string_view cell = line.substr(0, end);
        line.remove_prefix(std::min(end + 1, line.size()));
        const auto blank = [](char c) { return c == ' ' || c == '\r' || c == '+'; };
        while (!cell.empty() && blank(cell.front()))
            cell.remove_prefix(1);
        while (!cell.empty() && blank(cell.back()))
            cell.remove_suffix(1);
        double value = 0.0;
        const auto [stopped, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || stopped != cell.data() + cell.size()) {
            if (!numbers.empty()) numbers.push_back(HUGE_VAL);  // no heading: a damaged line
            return numbers;
        }
        numbers.push_back(value);
    }
    return numbers;
}

Result<Recording> textIn(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) return fail(Fault::notFound, "\"" + path.string() + "\" cannot be opened; check its name.");
    Recording recording;
    std::vector<double> times;
    std::size_t columns = 0, lineNumber = 0;
    for (std::string line; std::getline(in, line);) {
        ++lineNumber;
        if (line.size() > 4096) return bad(path, "is neither a sound file nor a table.");
        const auto numbers = numbersIn(line);
        const bool blank = line.find_first_not_of(" \t\r\n") == std::string::npos;
        if (blank || (numbers.empty() && times.empty())) continue;
        if (columns == 0) columns = numbers.size();
        // A scope stopped in the middle of its last row: a time and empty cells.
        if (numbers.size() == 1 && columns > 1 && in.peek() == std::ifstream::traits_type::eof()) break;
        const auto finite = [](double value) { return std::isfinite(value); };
        if (columns < 2 || columns > 3 || numbers.size() != columns ||
            !std::all_of(numbers.begin(), numbers.end(), finite))
            return bad(path, "line " + std::to_string(lineNumber) +
                                 " is not two or three numbers: seconds, then light, or trigger and light.");
        if (times.size() >= static_cast<std::size_t>(kMost)) return bad(path, "is too long; a minute is plenty.");
        times.push_back(numbers.front());
        if (columns == 3) recording.trigger.push_back(numbers[1]);
        recording.light.push_back(numbers.back());
    }
    if (times.size() < 2) return bad(path, "holds no samples.");
    const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    for (std::size_t i = 1; i < times.size(); ++i) {
        const double expected = times.front() + step * static_cast<double>(i);
        if (!(step > 0.0) || std::abs(times[i] - expected) > 0.51 * step + 0.01 * step)
            return bad(path,
                       "has samples that are not equally spaced in time, near " + std::to_string(times[i]) + " s.");
    }
    recording.samplesPerSecond = 1.0 / step;
    return recording;
}

}  // namespace

Result<Recording> readRecording(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        return fail(Fault::notFound, "\"" + path.string() + "\" is no file; name a recording (.csv, .wav or .flac).");
    auto recording = soundIn(path).value_or(Result<Recording>(Recording{}));
    if (!recording) return recording;
    if (recording->light.empty()) recording = textIn(path);
    if (recording && recording->light.size() < kFewest)
        return bad(path, "has only " + std::to_string(recording->light.size()) + " samples; record a second or more.");
    return recording;
}

}  // namespace ilf::devices
