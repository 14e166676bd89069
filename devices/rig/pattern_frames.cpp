#include "devices/rig/pattern_frames.h"

#include "devices/dlpc350/frame.h"

namespace ilf::devices {
namespace {

class PatternFrames {
public:
    explicit PatternFrames(int depth) : depth_(depth) {}

    Result<PatternFrame> operator()(const Program& program) {
        auto frame =
            former_ ? dlpc350::repacked(*std::move(former_), *before_, program) : dlpc350::packed(program, depth_);
        former_.reset();
        if (!frame) return tl::unexpected(frame.error());
        former_ = *std::move(frame);
        before_ = program;
        return PatternFrame{{former_->picture.size, 3, former_->picture.rgb}, former_->sequence};
    }

private:
    int depth_;
    std::optional<dlpc350::PackedFrame> former_;
    std::optional<Program> before_;
};

}  // namespace

std::function<Result<PatternFrame>(const Program&)> patternFrames(int depth) { return PatternFrames(depth); }

}  // namespace ilf::devices
