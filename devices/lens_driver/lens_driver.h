// An Optotune lens driver 4 or 4i on a serial line: static powers and currents, and a sine for the bench.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "core/lens/waveform.h"
#include "devices/clock.h"
#include "devices/lens_driver/limits.h"
#include "devices/lens_driver/messages.h"
#include "devices/serial/serial_link.h"

namespace ilf::devices {

/// How a rig wants one lens to be treated.
struct LensSetup {
    std::string name = "lens";  ///< for messages: "left lens"
    LensProtection protection;
    /// The wearer's resting power. It is held by the driver's own focal power mode where firmware and lens allow it
    /// (0.1 D, after a few minutes of warming); else by `restCurrent`; 0 mA only where there is neither.
    std::optional<Dioptre> restPower;
    /// From a calibration at the lens's working temperature.
    std::optional<Ampere> restCurrent;
    /// Within which temperatures the driver shall promise its focal powers.
    double coldest_C = 20.0, warmest_C = 45.0;
};

/// What was read when it was opened.
struct LensDriverFacts {
    char firmwareType = 0;
    lens_driver::Version version;
    std::string lensSerial;  ///< empty: the lens has no memory
    Ampere most;             ///< what full scale is
    CurrentLimits limits;    ///< what it will be driven with at most
    /// None: no focal power mode, no resting power was asked for, or holding it takes more current than is allowed.
    std::optional<lens_driver::PowerRange> powers;
};

/// What the last heartbeat read.
struct LensDriverState {
    lens_driver::Mode mode = lens_driver::Mode::current;
    Ampere current;  ///< of a sine: that of one moment
    double temperature_C = 0.0;
    lens_driver::Status status;
    std::vector<std::string> warnings;  ///< one clause each: warm, or a bit of its status
};

/// Whether a lens driver can play `wave` in a show: only one that stands still. Its sine runs free on its own crystal
/// and there is no trigger input, so a moving one is refused.
Result<void> checkedForShow(const Waveform& wave);

/// Opening it says "Start", which sets the current to 0, then goes to rest. Any error of a call, an answer that does
/// not fit what was asked, and a lens that is too hot send the lens to rest; the driver must then be opened again. It
/// goes to rest before it is destroyed, too. The EEPROM is never written.
///
/// The driver has no watchdog: if the process is killed, the lens keeps doing what it did last. Only a supervisor that
/// opens the port again can bring it to rest.
class LensDriver {
public:
    static Result<std::unique_ptr<LensDriver>> open(std::unique_ptr<SerialLink> link, LensSetup setup,
                                                    Clock clock = Clock::steady());
    ~LensDriver();
    LensDriver(const LensDriver&) = delete;
    LensDriver& operator=(const LensDriver&) = delete;

    const LensDriverFacts& facts() const { return facts_; }

    /// Gives the current that flows, which is `current` clamped to `facts().limits`.
    Result<Ampere> holdCurrent(Ampere current);
    /// `outOfRange` if the lens cannot reach it, `unsupported` without focal power mode; neither is a fault.
    Result<void> holdPower(Dioptre power);
    /// For bench tests only: 0.2 to 500 Hz, between two currents (clamped).
    Result<void> sineForBench(Hertz frequency, Ampere low, Ampere high);
    /// Reads mode, current or frequency, temperature and status, and compares them with what was asked for.
    Result<LensDriverState> heartbeat();
    /// To the resting power within 100 ms, in small steps. Works after a fault, too; all ways to rest are tried before
    /// there is an error. What then is not known is where the lens stands.
    Result<void> rest();

private:
    LensDriver(std::unique_ptr<SerialLink> link, LensSetup setup, Clock clock);

    Result<void> opened();
    Result<void> shakenHands();
    void findPowers();
    Result<void> usable() const;
    Result<LensDriverState> readBack();

    Result<void> told(const lens_driver::Command& command);
    Result<Bytes> asked(const lens_driver::Command& command, Milliseconds limit);
    Result<void> drained();
    void discarded(Milliseconds quiet);
    Result<void> switched(lens_driver::Mode mode);
    int codeFor(Ampere current) const;  ///< clamped
    bool allowed(Ampere flowing) const;
    Result<void> sendCurrent(Ampere current);
    Result<void> sendPower(Dioptre power);

    Result<void> currentAllowed();
    Result<void> restedByPower();
    Result<void> restedByCurrent();
    /// Sends the lens to rest because of `error`, which it gives back.
    tl::unexpected<Error> faulted(Error error);
    Error refusal(const lens_driver::Command& command, const lens_driver::Frame& frame) const;

    std::unique_ptr<SerialLink> link_;
    LensSetup setup_;
    Clock clock_;
    LensDriverFacts facts_;
    bool handshake_ = false;  ///< it is a lens driver: it may be sent to rest
    std::optional<Error> fault_;
    std::optional<lens_driver::Mode> mode_;  ///< none: it may be in any
    int code_ = 0;                           ///< last current told
    Dioptre power_;                          ///< last focal power told
    Hertz frequency_;                        ///< of the sine
};

}  // namespace ilf::devices
