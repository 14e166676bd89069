#include <cmath>

#include "devices/dlpc350/lightcrafter.h"
#include "devices/dlpc350/lightcrafter_set.h"

// The order of operations of TI's guide (devices 1.7). Every step that can be read back is.
namespace ilf::devices::dlpc350 {
namespace {

constexpr Second kPollPause = 100.0_ms;
constexpr int kMostPolls = 20;
/// Several drivers found that the first start is not enough.
constexpr Second kSecondStart = 100.0_ms;
/// Asking disturbs running patterns.
constexpr Second kAskPause = 1.0_s;

}  // namespace

Result<Started> LightCrafter::start(const PatternSequence& sequence) {
    const auto video = measuredVideo();
    if (!video) return tl::unexpected(video.error());
    if (const auto ok = checkedSequence(sequence, 1.0 / video->refresh); !ok) return tl::unexpected(ok.error());
    auto started = arranged(sequence, *video);
    if (!started) return tl::unexpected(stoppedAfter(started.error()));
    return started;
}

Result<Started> LightCrafter::arranged(const PatternSequence& sequence, const VideoSignal& video) {
    if (const auto ok = stop(); !ok) return tl::unexpected(ok.error());
    wait(twoFrames());
    if (const auto ok = setDisplay(Display::pattern); !ok) return tl::unexpected(ok.error());
    if (const auto ok = set(PatternSource::videoPort); !ok) return tl::unexpected(ok.error());
    if (const auto ok = setTimes(sequence); !ok) return tl::unexpected(ok.error());
    if (const auto ok = setTable(sequence); !ok) return tl::unexpected(ok.error());
    if (const auto ok = setTriggers(); !ok) return tl::unexpected(ok.error());
    const auto remarks = checkedByBoard();
    if (!remarks) return tl::unexpected(remarks.error());
    if (const auto ok = startedTwice(); !ok) return tl::unexpected(ok.error());
    if (const auto ok = confirmedRunning(); !ok) return tl::unexpected(ok.error());
    toldToRun_ = true;
    return Started{video, *remarks};
}

Result<void> LightCrafter::setTimes(const PatternSequence& sequence) {
    const int entries = static_cast<int>(sequence.entries.size());
    if (const auto ok = set(LutControl{entries, true, entries, 1}); !ok) return ok;
    if (const auto ok = set(TriggerMode::vsync); !ok) return ok;
    const auto us = static_cast<std::uint32_t>(wholeMicroseconds(sequence.entries.front().exposure));
    return set(ExposurePeriod{us, us});
}

Result<void> LightCrafter::setTable(const PatternSequence& sequence) {
    const std::vector<LutEntry> told = lutOf(sequence, bringUp_.swapAtFrame);
    if (const auto ok = board_.tell(kCommandOf<Mailbox>, payloadOf(Mailbox::patterns)); !ok) return ok;
    if (const auto ok = board_.tell(kCommandOf<MailboxOffset>, payloadOf(MailboxOffset{0})); !ok) return ok;
    if (const auto ok = board_.tell(kMailboxData, lutBytes(told)); !ok) return ok;
    if (const auto ok = board_.tell(kCommandOf<Mailbox>, payloadOf(Mailbox::closed)); !ok) return ok;
    return bringUp_.readTableBack ? comparedTable(told) : Result<void>{};
}

Result<void> LightCrafter::comparedTable(const std::vector<LutEntry>& told) {
    if (const auto ok = board_.tell(kCommandOf<Mailbox>, payloadOf(Mailbox::patterns)); !ok) return ok;
    if (const auto ok = board_.tell(kCommandOf<MailboxOffset>, payloadOf(MailboxOffset{0})); !ok) return ok;
    const auto data = board_.ask(kMailboxData);
    if (!data) return tl::unexpected(data.error());
    if (const auto ok = board_.tell(kCommandOf<Mailbox>, payloadOf(Mailbox::closed)); !ok) return ok;

    const auto found = parsedLut(*data, told.size());
    if (!found)
        return tl::unexpected(about("gave its pattern table back cut short: " + found.error().what +
                                    " Start again; if it stays so, switch its power off and on."));
    for (std::size_t i = 0; i < told.size(); ++i)
        if ((*found)[i] != told[i])
            return tl::unexpected(about("was told entry " + std::to_string(i) + " of the pattern table \"" +
                                        inWords(told[i]) + "\" but says \"" + inWords((*found)[i]) +
                                        "\". Start again; if it stays so, switch its power off and on."));
    return {};
}

Result<void> LightCrafter::setTriggers() {
    if (bringUp_.triggerOut1)
        if (const auto ok = set(*bringUp_.triggerOut1); !ok) return ok;
    if (bringUp_.triggerOut2)
        if (const auto ok = set(*bringUp_.triggerOut2); !ok) return ok;
    // Left by another program in manual control, every pattern would be white or grey.
    const auto leds = board_.ask<LedControl>();
    if (!leds) return tl::unexpected(leds.error());
    if (leds->sequencer) return {};
    return set(LedControl{});
}

Result<std::vector<std::string>> LightCrafter::checkedByBoard() {
    if (const auto ok = board_.tell(kCommandOf<Validation>, validationRequest()); !ok)
        return tl::unexpected(ok.error());
    for (int polls = 0;; ++polls) {
        const auto found = board_.ask<Validation>();
        if (!found) return tl::unexpected(found.error());
        if (found->mayStart()) return remarks(*found);
        if (!found->busy || polls == kMostPolls) {
            std::string why = "does not accept the pattern table.";
            for (const std::string& trouble : troubles(*found))
                why += " " + trouble;
            return tl::unexpected(about(why));
        }
        wait(kPollPause);
    }
}

Result<void> LightCrafter::startedTwice() {
    const auto order = payloadOf(PatternRun::running);
    if (const auto ok = board_.tell(kCommandOf<PatternRun>, order); !ok) return ok;
    wait(kSecondStart);
    return board_.tell(kCommandOf<PatternRun>, order);
}

Result<void> LightCrafter::confirmedRunning() {
    constexpr int kMostAsks = 3;
    wait(twoFrames());
    for (int asks = 1;; ++asks) {
        const auto run = board_.ask<PatternRun>();
        if (!run) return tl::unexpected(run.error());
        const auto status = board_.ask<MainStatus>();
        if (!status) return tl::unexpected(status.error());
        if (*run == PatternRun::running && status->sequencerRunning) break;
        if (asks == kMostAsks)
            return tl::unexpected(about("was told to start its patterns but says they are " + inWords(*run) +
                                        (status->sequencerRunning ? "." : " and its sequencer rests.") +
                                        " Check that its video still comes."));
        wait(kAskPause);
    }
    const auto hardware = board_.ask<HardwareStatus>();
    if (!hardware) return tl::unexpected(hardware.error());
    const auto wrong = troubles(*hardware);
    if (wrong.empty()) return {};
    return tl::unexpected(about("started its patterns, but not well: " + wrong.front()));
}

}  // namespace ilf::devices::dlpc350
