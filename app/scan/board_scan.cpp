#include "app/scan/board_scan.h"

#include <utility>

#include "app/words.h"
#include "devices/scan/core_show.h"

namespace ilf::app {
namespace {

/// A PatternCamera proves that two pictures are of a pattern and of its inverse, whatever these look like: here the
/// board takes the place of the widest stripes.
class BoardShow : public devices::PatternShow {
public:
    BoardShow(devices::PatternShow& show, const Pattern& pattern)
        : show_(show), pattern_(patternPicture(pattern, show.projector())),
          inverse_(patternPicture({pattern.kind, pattern.bit, true}, show.projector())) {}

    Result<Second> show(const Image<std::uint8_t>& picture) override {
        if (picture == pattern_) return show_.show(projectedBoardPicture(projector(), false));
        if (picture == inverse_) return show_.show(projectedBoardPicture(projector(), true));
        return show_.show(picture);
    }
    void safe() noexcept override { show_.safe(); }
    Size projector() const override { return show_.projector(); }
    Second sweep() const override { return show_.sweep(); }

private:
    devices::PatternShow& show_;
    Image<std::uint8_t> pattern_, inverse_;
};

}  // namespace

Result<PairedRegistration> scannedBoard(const ScanOrder& order, const devices::ScanWatch& watch,
                                        const std::stop_token& stop) {
    const auto camera = openedCamera(order);
    if (!camera) return tl::unexpected(camera.error());
    const Pattern stands{Pattern::Kind::column, 0, false};
    devices::CoreShow light(order.runtimeDirectory, order.rig, order.rest, stop);
    BoardShow show(light, stands);
    devices::PatternCamera taker(**camera, show, order.wish, watch, stop);
    const auto seen = [&]() -> Result<devices::PatternCamera::Pair> {
        if (const auto begun = taker.begin(); !begun) return tl::unexpected(begun.error());
        taker.tell(devices::ScanProgress::Step::patterns, 0, 2, "Showing the chessboard and its inverse");
        return taker.pair(stands);
    }();
    light.safe();
    if (!seen) return tl::unexpected(seen.error());
    auto found = registeredByBoard(seen->picture, seen->inverse, order.rig.projector);
    if (!found) return found;
    found->registration.camera = (*camera)->mode();
    if (found->registration.camera.picture == Size{}) found->registration.camera.picture = seen->picture.size();
    found->registration.taken = utcNow();
    found->registration.projectorName = order.rig.name;
    found->registration.provenance = provenanceOf(order);
    return found;
}

}  // namespace ilf::app
