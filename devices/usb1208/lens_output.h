// Both lenses on the outputs of a USB-1208FS-Plus: sweeps without a pause, and rest whenever something is wrong.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/lens/waveform.h"
#include "devices/clock.h"
#include "devices/usb/usb_link.h"
#include "devices/usb1208/sweep_player.h"

namespace ilf::devices {

struct LensOutputSetup {
    LensChannels channels;
    /// Transfers of 10 ms that are always queued. More bear a busier host, and make swaps and slips later: by 10 ms
    /// each, besides the 43 ms that the device buffers.
    int transfersInFlight = 4;
};

/// When a change is heard by the lenses, counted in samples since the scan started.
struct PlayedChange {
    Change change;
    std::int64_t heardFrom = 0;  ///< sample that the device plays about now
    /// About how long until the new waves play alone. Until then there must be no slotted light.
    Second wait() const;
};

struct LensOutputReport {
    bool sweeping = false;
    /// Whether outputs can be read back while they hold: what was written was found at opening. The vendor's library
    /// does not use that request, so a device may not have it.
    bool readsBack = false;
    Ampere left, right;  ///< told last
    std::int64_t frames = 0;
};

/// Opening stops whatever ran and holds rest. An underrun, a stream that ends, a device that does not do what it was
/// told and any error of a call end in rest and stay an error until it is opened again. It goes to rest before it is
/// destroyed. Calls come from one thread; samples are made on the stream's own.
class LensOutput {
public:
    static Result<std::unique_ptr<LensOutput>> open(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup,
                                                    Clock clock = Clock::steady());
    ~LensOutput();
    LensOutput(const LensOutput&) = delete;
    LensOutput& operator=(const LensOutput&) = delete;

    /// Starts sweeping, from rest, or changes to these waves at the start of a sweep. Waves that cannot be played are
    /// refused and change nothing. Another rate goes through rest.
    Result<PlayedChange> play(const Waveform& left, const Waveform& right);
    /// See `SweepPlayer`; `unsupported` at rest.
    Result<void> slip(int samples);
    Result<Change> shift(int samples);
    /// Whether it still does what it was told; to be called every 100 ms.
    Result<LensOutputReport> heartbeat();
    /// Ramps to rest within 100 ms and holds it: from what the outputs read back, else from what they were told last,
    /// and in one step only where neither is known. A device that refuses to be told but goes on taking samples is
    /// brought to rest by those, later by what is queued and buffered. Works from any state; an error means that the
    /// device could not be told, and then is gone or must be unplugged.
    Result<void> safe();

    /// Where a sample that is or was played stands; none at rest.
    std::optional<SweepPlayer::Place> placeOf(double frame) const;
    /// See `SweepPlayer`; a fundamental of 0 at rest.
    SweepPlayer::Tone leftTone() const;
    std::chrono::nanoseconds startedAt() const { return startedAt_; }
    int samplesPerSweep() const;
    /// The sample that is played about now, from the time since the start (its clock is the DAC's, within ppm).
    double playedFrames() const;

private:
    LensOutput(std::shared_ptr<UsbLink> link, const LensOutputSetup& setup, Clock clock);

    Result<void> opened();
    Result<void> started(std::size_t samples);
    Result<void> usable() const;
    Result<LensOutputReport> checkedNow();
    Result<void> stopped();
    bool restedByStream();
    Result<void> held(Ampere left, Ampere right);
    std::optional<std::pair<Ampere, Ampere>> readOutputs();
    tl::unexpected<Error> faulted(Error error);

    std::shared_ptr<UsbLink> link_;
    LensOutputSetup setup_;
    Clock clock_;
    std::optional<Error> fault_;
    bool readsBack_ = false, sweeping_ = false;
    bool streamRests_ = false;  ///< could not be stopped, and plays nothing but rest that it was sent
    std::optional<std::pair<Ampere, Ampere>> told_;  ///< last, left and right; none: nothing yet
    std::chrono::nanoseconds startedAt_{0};
    mutable std::mutex mutex_;  ///< guards `player_`
    std::optional<SweepPlayer> player_;
    std::unique_ptr<UsbStream> stream_;  ///< last: it ends before what it fills from
};

}  // namespace ilf::devices
