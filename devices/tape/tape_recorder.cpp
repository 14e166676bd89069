#include "devices/tape/tape_recorder.h"

namespace ilf::devices {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;
constexpr std::size_t kEntryBytes = 128;  // what an entry takes besides its bytes, about

}  // namespace

Result<std::shared_ptr<TapeRecorder>> TapeRecorder::into(const std::filesystem::path& file, Clock clock) {
    auto recorder = std::make_shared<TapeRecorder>(std::move(clock));
    recorder->file_.open(file, std::ios::binary);
    recorder->write(firstTapeLine());
    if (recorder->full_)
        return fail(Fault::cannotWrite, "The tape " + file.string() +
                                            " cannot be written. Choose a folder that you may write to, with room.");
    return recorder;
}

void TapeRecorder::about(const std::string& key, const std::string& value) {
    const std::scoped_lock lock(mutex_);
    for (const auto& [known, said] : tape_.about)
        if (known == key) return;
    tape_.about.emplace_back(key, value);
    if (file_.is_open()) write(tapeLine(key, value));
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
    if (file_.is_open()) return write(tapeLine(entry));
    full_ = full_ || bytes_ + entry.bytes.size() + kEntryBytes > kMostBytes;
    if (full_) return;
    bytes_ += entry.bytes.size() + kEntryBytes;
    tape_.entries.push_back(std::move(entry));
}

void TapeRecorder::write(const std::string& line) {
    if (!full_) full_ = !(file_ << line << std::flush);
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
