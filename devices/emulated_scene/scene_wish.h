// What the emulated scene and its camera shall be, and what goes wrong with them, in words.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/geometry.h"
#include "core/base/result.h"

namespace ilf::devices {

/// Words, with commas between them; all may be left out:
///
///     scene=FILE       glTF (.glb, .gltf) on the desk instead of its things, or depth (.exr, .png, .pfm) as the camera
///                      sees it; a name with commas stands in double quotes: scene="a, b.glb"
///     scale=0.1        the file's lengths times this are metres
///     board=3          the chessboard in this pose (1..12) instead of the desk's things or the scene
///     binning=2        sensor pixels put together; roi=X:Y:WIDTH:HEIGHT the part read out, in unbinned pixels
///     ambient=200      lux from elsewhere (15 is a dim room; the projector gives some 400)
///     delay=2          every frame is the one of 2 frames before
///     bump=3, turn=0.2 the camera was moved by so many millimetres, turned by so many degrees
///     hand             a hand reaches into the view
///     marker=7         a card with AprilTag 36h11 number 0 to 9 is held before the scene (moving_marker.h)
///     lap=4            and goes round once in so many seconds; 0: it stays
///     cover=2:3.5      and is covered from so many seconds on until so many
///     saturated, dark  far too much, far too little light
///     wrong-screen     the projector shows somebody's desktop instead of what it is told
///     frozen           the same picture again and again
///     after=20         the words from delay on come true after so many frames
///     quiet, seed=7    no noise; other noise
struct SceneWish {
    std::string scene;  ///< a file; empty: the desk's own things
    double scale = 1.0;
    int board = 0, binning = 1;
    int roiX = 0, roiY = 0;
    Size roi;  ///< 0 x 0: the whole sensor
    double ambientLux = 15.0;
    int delay = 0;
    double bump_mm = 0.0, turn_deg = 0.0;
    int marker = -1;  ///< -1: none
    double lap_s = 0.0, coveredFrom_s = 0.0, coveredTo_s = 0.0;
    bool hand = false, saturated = false, dark = false, wrongScreen = false, frozen = false;
    int after = 0;
    bool quiet = false;
    int seed = 1;
    bool operator==(const SceneWish&) const = default;
};

/// Refused, naming the word: unknown, or a number that cannot be.
Result<SceneWish> sceneWishFrom(std::string_view words);
/// The words that give `wish`.
std::string wordsOf(const SceneWish& wish);

/// A wish for the emulated cameras that look at this runtime directory: taken with the next frame of those that are
/// open, and by those opened later without words of their own. "emulated-camera" in the directory; written whole or not
/// at all.
Result<void> saveSceneWish(const std::filesystem::path& runtimeDirectory, const SceneWish& wish);
/// None: nobody wished.
Result<std::optional<SceneWish>> savedSceneWish(const std::filesystem::path& runtimeDirectory);
std::filesystem::path sceneWishFile(const std::filesystem::path& runtimeDirectory);

}  // namespace ilf::devices
