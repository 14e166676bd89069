#include "devices/tape/tape_player.h"

#include <algorithm>

namespace ilf::devices {
namespace {

constexpr std::size_t kShown = 16;  // bytes of a message in an error

std::string lineOf(const TapeEntry& entry) {
    return entry.line > 0 ? "line " + std::to_string(entry.line) + " of the tape" : "the tape";
}

std::string called(const std::string& what, const std::string& where) {
    return "\"" + what + (where.empty() ? "" : " " + where) + "\"";
}

}  // namespace

Result<std::vector<std::uint8_t>> TapePlayer::next(const std::string& what, const std::string& where) {
    if (const auto ok = soFar(); !ok) return tl::unexpected(ok.error());
    const TapeEntry* entry = current();
    if (entry == nullptr || entry->what != what || entry->where != where) return differs(entry, called(what, where));
    ++at_;
    if (entry->failed) return fail(Fault::device, entry->failure);
    return entry->bytes;
}

Result<void> TapePlayer::nextSent(const std::string& what, const std::string& where,
                                  std::span<const std::uint8_t> bytes) {
    if (const auto ok = soFar(); !ok) return ok;
    const TapeEntry* entry = current();
    const bool same = entry != nullptr && entry->what == what && entry->where == where &&
                      std::equal(bytes.begin(), bytes.end(), entry->bytes.begin(), entry->bytes.end());
    if (!same) return differs(entry, called(what, where) + " " + hexOf({bytes.begin(), bytes.end()}, kShown));
    ++at_;
    if (entry->failed) return fail(Fault::device, entry->failure);
    return {};
}

const TapeEntry* TapePlayer::current() { return at_ < tape_.entries.size() ? &tape_.entries[at_] : nullptr; }

tl::unexpected<Error> TapePlayer::differs(const TapeEntry* entry, const std::string& asked) {
    if (entry == nullptr)
        difference_ = "The tape has ended, but the driver asks for " + asked + ".";
    else
        difference_ = "The driver asks for " + asked + ", but " + lineOf(*entry) + " has " +
                      called(entry->what, entry->where) + " " + hexOf(entry->bytes, kShown) + ".";
    return fail(Fault::device, difference_);
}

Result<void> TapePlayer::soFar() const {
    if (difference_.empty()) return {};
    return fail(Fault::device, difference_);
}

Result<void> TapePlayer::finished() const {
    if (const auto ok = soFar(); !ok) return ok;
    if (at_ == tape_.entries.size()) return {};
    const TapeEntry& entry = tape_.entries[at_];
    return fail(Fault::device, "The driver did not ask for " + called(entry.what, entry.where) + ", " + lineOf(entry) +
                                   ", and what follows.");
}

}  // namespace ilf::devices
