// Shows patterns through an output core: programs whose every slot is the picture and whose wave rests.
#pragma once

#include <chrono>
#include <filesystem>
#include <stop_token>

#include "core/document/rig.h"
#include "devices/link/core_link.h"
#include "devices/scan/pattern_show.h"

namespace ilf::devices {

/// The program that shows `picture` in every slot of `rig`, lenses at `rest`. Its slot rate is the rig's, so that none
/// changes between it and a show, or between pictures.
Program restingProgram(const Rig& rig, Dioptre rest, const Image<std::uint8_t>& picture);

/// A link of its own to the core of `runtimeDirectory`, which must run: beside a studio's, which must not send
/// meanwhile. The first picture is a take; when safe light is asked for by anybody after it, showing is refused.
class CoreShow : public PatternShow {
public:
    CoreShow(const std::filesystem::path& runtimeDirectory, Rig rig, Dioptre rest, std::stop_token stop = {});

    Result<Second> show(const Image<std::uint8_t>& picture) override;
    /// Keeps the link alive for `time` while what was shown last stays; refused once somebody asked for safe light.
    Result<void> hold(std::chrono::milliseconds time);
    void safe() noexcept override;
    Size projector() const override { return rig_.projector; }
    Second sweep() const override { return 1.0 / rig_.sweepRate; }
    const Status& status() const { return link_.status(); }

private:
    CoreLink link_;
    Rig rig_;
    Dioptre rest_;
    std::stop_token stop_;
    std::uint64_t revision_ = 0;
};

}  // namespace ilf::devices
