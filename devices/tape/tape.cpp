#include "devices/tape/tape.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

namespace ilf::devices {
namespace {

constexpr const char* kFirstLine = "illuminatedfocus tape 1";
constexpr const char* kFailed = "failed";

std::string oneLine(std::string text) {
    std::replace_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

std::optional<std::vector<std::uint8_t>> bytesOf(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    int high = -1;
    for (const char c : text) {
        if (c == ' ') continue;
        const int d = digit(c);
        if (d < 0) return std::nullopt;
        if (high < 0) {
            high = d;
        } else {
            bytes.push_back(static_cast<std::uint8_t>(high * 16 + d));
            high = -1;
        }
    }
    if (high >= 0) return std::nullopt;
    return bytes;
}

tl::unexpected<Error> badLine(int line, const std::string& why) {
    return fail(Fault::badFile, "Line " + std::to_string(line) + " of the tape " + why + ".");
}

/// "0.001250 out 01 failed : sentence | bytes": a failed exchange has the sentence first, then what was to be sent.
Result<TapeEntry> parsedEntry(const std::string& text, int line) {
    const std::size_t colon = text.find(" :");
    if (colon == std::string::npos) return badLine(line, "has no colon");
    std::istringstream head(text.substr(0, colon));
    TapeEntry entry;
    entry.line = line;
    std::string time, word;
    if (!(head >> time >> entry.what)) return badLine(line, "does not begin with a time and a word");
    char* end = nullptr;
    entry.at = std::strtod(time.c_str(), &end) * 1.0_s;
    if (end == time.c_str() || *end != '\0' || !isFinite(entry.at)) return badLine(line, "does not begin with a time");
    while (head >> word) {
        if (word == kFailed)
            entry.failed = true;
        else
            entry.where += (entry.where.empty() ? "" : " ") + word;
    }
    std::string rest = text.substr(std::min(colon + 3, text.size()));
    if (entry.failed) {
        const std::size_t bar = rest.rfind('|');
        if (bar == std::string::npos) return badLine(line, "does not end with | and the bytes that were to be sent");
        entry.failure = rest.substr(0, bar == 0 ? 0 : bar - 1);
        rest = rest.substr(bar + 1);
    }
    const auto bytes = bytesOf(rest);
    if (!bytes) return badLine(line, "has something else than pairs of hexadecimal digits");
    entry.bytes = *bytes;
    return entry;
}

}  // namespace

std::string Tape::of(const std::string& key) const {
    for (const auto& [name, value] : about)
        if (name == key) return value;
    return {};
}

std::string hexOf(const std::vector<std::uint8_t>& bytes, std::size_t most) {
    std::string text;
    char byte[4];
    for (std::size_t i = 0; i < std::min(bytes.size(), most); ++i) {
        std::snprintf(byte, sizeof byte, "%02X", bytes[i]);
        text += (i == 0 ? "" : " ") + std::string(byte);
    }
    if (bytes.size() > most) text += " ...";
    return text;
}

std::string firstTapeLine() { return std::string(kFirstLine) + "\n"; }

std::string tapeLine(const std::string& key, const std::string& value) {
    return "about " + key + " " + oneLine(value) + "\n";
}

std::string tapeLine(const TapeEntry& entry) {
    char time[32];
    std::snprintf(time, sizeof time, "%.6f", entry.at.si());
    std::string text = std::string(time) + " " + entry.what + (entry.where.empty() ? "" : " " + entry.where);
    if (entry.failed)
        text += std::string(" ") + kFailed + " : " + oneLine(entry.failure) + " |";
    else
        text += " :";
    return text + (entry.bytes.empty() ? "" : " ") + hexOf(entry.bytes) + "\n";
}

std::string tapeText(const Tape& tape) {
    std::string text = firstTapeLine();
    for (const auto& [key, value] : tape.about)
        text += tapeLine(key, value);
    for (const TapeEntry& entry : tape.entries)
        text += tapeLine(entry);
    return text;
}

Result<Tape> parsedTape(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line) || line != kFirstLine)
        return fail(Fault::badFile, std::string("This is no tape: its first line is not \"") + kFirstLine + "\".");
    Tape tape;
    for (int number = 2; std::getline(lines, line); ++number) {
        if (line.empty()) continue;
        if (line.rfind("about ", 0) == 0) {
            const std::size_t space = line.find(' ', 6);
            if (space == std::string::npos) return badLine(number, "has no value");
            tape.about.emplace_back(line.substr(6, space - 6), line.substr(space + 1));
            continue;
        }
        auto entry = parsedEntry(line, number);
        if (!entry) return tl::unexpected(entry.error());
        tape.entries.push_back(*std::move(entry));
    }
    return tape;
}

Result<void> saveTape(const Tape& tape, const std::filesystem::path& file) {
    std::ofstream out(file, std::ios::binary);
    out << tapeText(tape);
    out.close();
    if (!out) return fail(Fault::cannotWrite, "The tape " + file.string() + " could not be written. Is the disk full?");
    return {};
}

Result<Tape> loadTape(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return fail(Fault::notFound, "There is no tape " + file.string() + " that can be read.");
    std::ostringstream text;
    text << in.rdbuf();
    return parsedTape(text.str()).map_error([&](const Error& error) {
        return Error{error.fault, file.string() + ": " + error.what};
    });
}

}  // namespace ilf::devices
