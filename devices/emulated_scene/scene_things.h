// What stands in the emulated scene: triangles with a look, made in code, of a depth map or of a solid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/solid/mesh.h"
#include "devices/emulated_scene/scene_lens.h"

namespace ilf::devices::scene {

/// What a surface gives back of the light that falls on it.
struct Look {
    std::array<float, 3> colour{0.8F, 0.8F, 0.8F};  ///< of red, green and blue light, 0..1
    Image<float> texture;  ///< 3 channels, linear, multiplies `colour`; u, v of 0..1 span it; may be empty
    int squaresAcross = 0, squaresDown = 0;  ///< of a chessboard over u, v: every second one is `dark`; 0: none
    float dark = 0.06F;
    float gloss = 0.0F;  ///< share of light in a highlight (Phong, exponent 40) besides
};

struct Triangle {
    std::array<Vec3, 3> corner;
    std::array<Vec3, 3> normal;  ///< to shade with
    std::array<std::array<float, 2>, 3> uv{};
    std::int32_t surface = 0;  ///< pixels that see one surface only, evenly, need no finer look
    std::int32_t look = 0;
};

struct Things {
    std::vector<Triangle> triangles;
    std::vector<Look> looks;
    int surfaces = 0;

    int addLook(Look look);
    /// A parallelogram from `corner` along `along` (u) and `up` (v), seen from both sides.
    void addSheet(const Vec3& corner, const Vec3& along, const Vec3& up, int look);
    /// A box that stands on `foot` (centre of its underside), turned about z.
    void addBox(const Vec3& foot, const Vec3& size, double turn_deg, int look);
    void addBall(const Vec3& centre, double radius, int look);
    /// A rod with round ends.
    void addRod(const Vec3& from, const Vec3& to, double radius, int look);
};

/// The built-in desk: a desk with a printed sheet, two boxes and a ball.
Things deskThings();
/// A chessboard of 10 x 7 squares of 25 mm on a white plate, held above the desk: 9 x 6 inner corners.
inline constexpr int kBoardPoses = 12;
inline constexpr double kBoardSquare_m = 0.025;
inline constexpr int kBoardAcross = 10, kBoardDown = 7;
/// The board in `pose` (1..kBoardPoses): its upper left corner of the chessboard, along its width and down its height
/// (right, down), `ahead` away from whoever looks at its front.
Placed boardPose(int pose);
void addBoard(Things& things, const Placed& at);
/// A hand that reaches into the view.
void addHand(Things& things, const Vec3& palm);

/// Triangles of a solid, placed: x, y, z of its own frame times `scale`, then put into the world. Textures and colours
/// as its materials say.
Things thingsOf(const Solid& solid, const Placed& at, double scale = 1.0);
/// A depth map (z in metres along the axis, NaN: nothing) as `lens` at `from` saw it; steps of `grid` pixels, none
/// across a jump of more than `jump` of the depth.
Things thingsOfDepth(const Image<float>& depth, const SceneLens& lens, const Placed& from, int grid = 2,
                     double jump = 0.03);

}  // namespace ilf::devices::scene
