#include "devices/tape/tape_recorder.h"

namespace ilf::devices {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;
constexpr std::size_t kEntryBytes = 128;  // what an entry takes besides its bytes, about

}  // namespace

void TapeRecorder::about(const std::string& key, const std::string& value) {
    const std::scoped_lock lock(mutex_);
    tape_.about.emplace_back(key, value);
}

void TapeRecorder::succeeded(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes) {
    note({{}, what, where, false, {bytes.begin(), bytes.end()}, {}, 0});
}

void TapeRecorder::failed(const std::string& what, const std::string& where, std::span<const std::uint8_t> bytes,
                          const Error& why) {
    note({{}, what, where, true, {bytes.begin(), bytes.end()}, why.what, 0});
}

void TapeRecorder::note(TapeEntry entry) {
    const std::scoped_lock lock(mutex_);
    entry.at = std::chrono::duration<double>(clock_.now() - begun_).count() * 1.0_s;
    full_ = full_ || bytes_ + entry.bytes.size() + kEntryBytes > kMostBytes;
    if (full_) return;
    bytes_ += entry.bytes.size() + kEntryBytes;
    tape_.entries.push_back(std::move(entry));
}

Tape TapeRecorder::tape() const {
    const std::scoped_lock lock(mutex_);
    return tape_;
}

bool TapeRecorder::full() const {
    const std::scoped_lock lock(mutex_);
    return full_;
}

}  // namespace ilf::devices
