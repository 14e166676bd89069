// A scan taken live: shows each pattern, takes a picture of it, and proves that the picture is of that pattern.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/registration/ambient.h"
#include "core/registration/gray_code.h"
#include "core/registration/registration.h"
#include "devices/camera/camera_source.h"
#include "devices/scan/pattern_show.h"

namespace ilf::devices {

struct ScanWish {
    int sweeps = 0;       ///< of exposure; 0: as many as give good pictures, up to 16
    int mostLate = 6;     ///< frames that a camera may be behind what is shown
    bool anyway = false;  ///< goes on where the ambient check says no
};

/// What happens now, for the operator.
struct ScanProgress {
    enum class Step { light, marker, patterns, closing, check };
    Step step = Step::light;
    int done = 0, all = 1;          ///< pictures
    std::string words;              ///< "Showing columns, 4 of 11"
    Image<std::uint8_t> picture{};  ///< the newest, grey; may be empty
};
using ScanWatch = std::function<void(const ScanProgress&)>;

struct CapturedScan {
    Scan scan;
    CameraMode mode;
    AmbientCheck ambient;
    Second exposure;                   ///< 0: the camera does not tell
    int late = 0;                      ///< frames that were passed over after each pattern
    int repeated = 0;                  ///< pairs that were taken again since one picture was not of its pattern
    std::vector<std::string> remarks;  ///< what could not be set and what it may cost, one sentence each
};

/// Takes pictures of what a PatternShow shows, with one camera.
///
/// A picture counts when its frame came after first light and the exposure, after as many frames as this camera was
/// found to be late by, is like the frame before it but for noise (what still changes is not one pattern alone), is not
/// byte for byte the one before (a repeated frame is no picture), and, with its inverse, is a pair against white and
/// black. Where a pair is none it is taken again, one frame later.
class PatternCamera {
public:
    /// `stop` ends every wait. Both must outlive it.
    PatternCamera(CameraSource& camera, PatternShow& show, ScanWish wish, ScanWatch watch, std::stop_token stop);

    /// White, black and a marker: sets and locks the exposure, asks the room's light, and makes sure that the camera
    /// sees this projector. Refused in words: too dark, saturated, other light, another screen, frozen.
    Result<void> begin();
    /// The pattern and its inverse, proved.
    struct Pair {
        Image<std::uint8_t> picture, inverse;
    };
    Result<Pair> pair(const Pattern& pattern);
    /// White again: refused where something moved since `begin`.
    Result<void> unmoved();

    const Image<std::uint8_t>& white() const { return white_; }
    const Image<std::uint8_t>& black() const { return black_; }
    /// White again, once `unmoved` has refused; else empty.
    const Image<std::uint8_t>& moved() const { return moved_; }
    const CapturedScan& facts() const { return facts_; }
    void tell(ScanProgress::Step step, int done, int all, std::string words) const;

private:
    Result<Image<std::uint8_t>> frame();
    Result<Image<std::uint8_t>> taken(const Pattern& pattern, int late);
    Result<void> findExposure();
    Result<void> findLateness();
    Result<void> seesMarker();
    Result<void> somethingFollows();
    Error nothingFollows() const;
    Error frozen() const;
    double changed(const Image<std::uint8_t>& picture) const;

    CameraSource& camera_;
    PatternShow& show_;
    ScanWish wish_;
    ScanWatch watch_;
    std::stop_token stop_;
    Image<std::uint8_t> white_, black_, newest_, last_, moved_;
    Second frameTime_;       ///< when newest_ came
    double noise_ = 0.0;     ///< mean difference of two frames of the same, codes; 0: not known yet
    double restless_ = 0.0;  ///< changed() of two frames of the same
    CapturedScan facts_;
};

/// The whole scan, by a `taker` of this camera that has not begun. Whatever happens, it ends in steady white light with
/// the lens at rest. `then` is called before that, with all pictures taken, for what has to be shown besides; what it
/// refuses refuses the scan.
using AfterScan = std::function<Result<void>(PatternCamera&, const CapturedScan&)>;
Result<CapturedScan> capturedScan(PatternCamera& taker, CameraSource& camera, PatternShow& show,
                                  const AfterScan& then = {});
/// With a PatternCamera of its own. The one above leaves the caller what was seen until a refusal.
Result<CapturedScan> capturedScan(CameraSource& camera, PatternShow& show, const ScanWish& wish, const ScanWatch& watch,
                                  const std::stop_token& stop, const AfterScan& then = {});

}  // namespace ilf::devices
