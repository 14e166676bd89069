// The document: a scene, the regions painted on it, and what is known of wearer and rig. A value.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/base/image.h"
#include "core/base/result.h"
#include "core/base/tile_grid.h"
#include "core/document/distance.h"
#include "core/document/follow.h"
#include "core/document/rig.h"
#include "core/document/viewer_pose.h"
#include "core/document/wearer.h"

namespace ilf {

/// Stable name of a region: a UUID in files, any unique text in memory.
using RegionId = std::string;

/// The background's id: it takes part in looks and distances like a region, and lies under all of them.
inline const RegionId kBackgroundId = "background";

enum class Look {
    focus,    ///< lit while the lens is at rest: seen sharp
    blur,     ///< lit at the end of the sweep (or at a strength of its own): seen blurred
    neutral,  ///< lit evenly in all lit slots at the same mean luminance
};

/// An editable outline: the polygon a region was drawn as. Painting on the region dissolves it into pixels.
struct Outline {
    std::vector<Point<CameraFrame>> vertices;
    bool operator==(const Outline&) const = default;
};

/// On its way to another look: `share` (0 to 1) of its light is that look's already, the rest its own.
struct LookFade {
    Look look = Look::neutral;
    double share = 0.0;
    bool operator==(const LookFade&) const = default;
};

struct Region {
    RegionId id;
    std::string name;
    Look look = Look::focus;
    /// Blur only. Absent: lit at the end of the sweep, as in the paper. Present: lit at P_min + strength, which widens
    /// the sweep when it must.
    std::optional<Dioptre> strength;
    Distance distance;
    Mask mask;  ///< camera frame, the picture's size; the background's mask is empty and stands for everything
    std::optional<Outline> outline;
    std::optional<Follow> follow;  ///< absent: stays where it was painted
    std::optional<LookFade> fade;  ///< absent: its look alone; of the moment, in no file
    bool visible = true;
    bool locked = false;
    bool solo = false;
    bool operator==(const Region&) const = default;
};

/// Pixels per radian at the picture's centre, and where the camera's axis meets the picture.
struct PixelScale {
    enum class Source { assumed, exif, typed, calibrated };
    double focalPixels = 0.0;  ///< f_px; blur_px = f_px * D_r / d_er
    Source source = Source::assumed;
    bool operator==(const PixelScale&) const = default;
};

/// f_px of a picture `width` pixels wide that spans `degrees` across. Precondition: 0 < degrees < 180.
double focalPixels(int width, double degrees);
/// The way back, in degrees.
double fieldOfView(int width, double focalPixels);
inline constexpr double kDefaultFieldOfView = 60.0;

/// What the regions are painted on.
struct Scene {
    Box<Picture> picture;  ///< the frozen frame; its size is the size of every mask
    std::string source;    ///< file name, or the camera's stable id; for the operator
    PixelScale scale;
    Box<DepthMap> depth;  ///< distances from the wearer's lens; may be empty
    Box<MeasuredDepth>
        measured;       ///< what `depth` was made from, seen from the camera; may be empty: depth came as it is
    ViewerPose viewer;  ///< where the wearer is: `measured` and this make `depth`
    /// How a camera's picture was cut out of its sensor (of a picture of another size: nothing); see picture_change.h.
    CameraMode camera{};
    bool operator==(const Scene&) const = default;

    Size size() const { return picture ? picture->size() : Size{}; }
};

/// How the border between focused and blurred light is blended.
enum class Blending {
    none,             ///< hard masks: shows gap and overlap
    linearObject,     ///< the paper's two ramps, both in object coordinates
    linearPerceived,  ///< the paper's two ramps, the blurred one in apparent coordinates
    closedForm,       ///< w0 = 1 - PSF * m: exact for the nominal eye
};

struct Seam {
    Blending blending = Blending::closedForm;
    Metre feather = 10.0_mm;  ///< W, width of the ramp across the surface
    bool operator==(const Seam&) const = default;
};

struct Document {
    std::string name = "Untitled";
    Scene scene;
    std::vector<Box<Region>> regions;  ///< topmost first: the topmost visible region wins, by coverage
    Box<Region> background;            ///< id kBackgroundId
    Seam seam;
    Dioptre alpha = 0.2_D;  ///< added to P_s so that the driving region is surely blurred (paper, 3.3)
    Wearer wearer;          ///< saved in a file of its own
    Rig rig;                ///< saved in a file of its own
    bool operator==(const Document&) const = default;
};

/// A document over `scene`, with a neutral background at 2 m and no regions. A scene without a pixel scale gets the
/// default field of view.
Document newDocument(Scene scene);

/// The region or background of that id, or nullptr.
const Region* findRegion(const Document& document, const RegionId& id);

/// Regions that take part, topmost first: visible ones, or only the soloed ones if any visible region is soloed. The
/// background is not among them and always takes part.
std::vector<const Region*> activeRegions(const Document& document);

/// Where a camera pixel lands on the projector: the rig's registration, or the whole picture fitted into the raster,
/// centred, with equal scale in x and y.
PixelMap pixelMap(const Document& document);

/// The camera's axis in the picture: where a calibration says, else the middle of the sensor, else of the picture.
Point<CameraFrame> cameraAxis(const Document& document);

/// Where an eye's optical centre lies on a surface at `distance`, in the picture. Lens axes are parallel, so the
/// nearer the surface, the farther apart the two centres lie in pixels.
Point<CameraFrame> opticalCentre(const Document& document, Eye eye, Metre distance);

/// Camera pixels per metre across a surface at `distance` from the wearer's lens (the picture is the view from the
/// pupil): f_px / (distance + d_Ee).
double pixelsPerMetre(const Document& document, Metre distance);

/// Vergence of a region's surface over the picture; nothing for FromDepthMap. A plane whose anchors are on one line, or
/// that reaches infinity within the region's pixels, is an error. Outside the region the plane may well pass its
/// horizon: there the vergence is 0 or negative.
Result<std::optional<AffineVergence>> affineVergence(const Region& region);

/// Distance of the region's surface at a point of the picture, without its tolerance. A plane ends at
/// kFarthestDistance. For FromDepthMap: the map's value, nothing at a hole or without a map.
std::optional<Metre> distanceAt(const Document& document, const Region& region, Point<CameraFrame> at);

/// Nearest and farthest point of what is seen of a region (tolerances included), over the pixels where it covers at
/// least half and no active region above it does. For a region that covers nothing: of its distance alone, or nothing
/// if that needs pixels.
///
/// Constant: value -+ tolerance. Plane: its extremes over the centres of the pixels seen, ending at kFarthestDistance,
/// -+ tolerance. Depth map: the 0.1 % and 99.9 % quantiles of the pixels seen that have depth, each taken two standard
/// deviations nearer or farther where those are known, -+ tolerance: a few stray pixels of the sensor, which would
/// otherwise decide how far the lens must sweep, do not. Of more than 64 whole tiles, one pixel in 4 x 4 stands for the
/// others. A tolerance counts as two standard deviations.
struct DistanceRange {
    Metre nearest, farthest;
    double holes = 0.0;   ///< share of its pixels without depth
    Metre sigma = 0.0_m;  ///< one standard deviation of its distance, a mean over its pixels; 0: not known
    bool operator==(const DistanceRange&) const = default;
};
std::optional<DistanceRange> distanceRange(const Document& document, const Region& region);

}  // namespace ilf
