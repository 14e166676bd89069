// Any projector as a stage for rehearsing masks: one slot's picture or the mix of all, never slots in time.
#pragma once

#include <memory>
#include <optional>

#include "devices/rig/video_output.h"
#include "devices/stage.h"

namespace ilf::devices {

enum class StagePurpose { rehearsal, show };

/// What a rehearsal shows of a program: one slot's light, or (none) what all slots together give.
struct RehearsedLight {
    std::optional<int> slot;
};

/// The light stays: nothing is blurred by it, so it is refused for shows. No lens is driven. Light is sent as sRGB
/// codes, which is what such projectors expect.
class AnyProjectorStage : public Stage {
public:
    static Result<std::unique_ptr<AnyProjectorStage>> open(std::shared_ptr<VideoOutput> video, StagePurpose purpose,
                                                           RehearsedLight shown = {});

    /// Leaves white light.
    ~AnyProjectorStage() override { safeLight(); }

    /// Refuses programs for another raster than the display's, and slots that are not there.
    Result<void> load(const Program& program) override;
    Result<void> swap() override;
    Result<void> heartbeat() override;
    void safeLight() noexcept override;
    StageReport report() const override;
    std::string name() const override { return "any projector, for rehearsal: nothing is blurred"; }

private:
    std::string deviceLine() const;
    AnyProjectorStage(std::shared_ptr<VideoOutput> video, RehearsedLight shown)
        : video_(std::move(video)), chosen_(shown) {}

    std::shared_ptr<VideoOutput> video_;
    RehearsedLight chosen_;
    std::optional<VideoFrame> loaded_;
    bool everThere_ = false;
    std::optional<Error> trouble_;  ///< why its light is not known
    enum class Shows { unknown, white, rehearsal } shows_ = Shows::unknown;
};

}  // namespace ilf::devices
