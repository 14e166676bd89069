#include "devices/emulated_scene/scene_things.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ilf::devices::scene {
namespace {

constexpr double kPi = std::numbers::pi;

/// Numbers that are the same on every machine (SplitMix64), 0..1.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    double next() {
        state_ += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

private:
    std::uint64_t state_;
};

/// What lies on the desk is printed all over: a cutting mat of patches of moderate contrast, as a camera's features
/// want them.
Image<float> printedSheet() {
    constexpr int kWidth = 720, kHeight = 560, kPatches = 420;
    std::vector<float> pixels(3U * kWidth * kHeight, 0.62F);
    Dice dice(20);
    for (int i = 0; i < kPatches; ++i) {
        const int x0 = static_cast<int>(dice.next() * kWidth), y0 = static_cast<int>(dice.next() * kHeight);
        const int x1 = std::min(kWidth, x0 + 4 + static_cast<int>(dice.next() * 60.0));
        const int y1 = std::min(kHeight, y0 + 4 + static_cast<int>(dice.next() * 24.0));
        const double level = 0.3 + 0.5 * dice.next();
        const double warm = 0.12 * (dice.next() - 0.5);
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                float* pixel =
                    pixels.data() + 3U * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
                pixel[0] = static_cast<float>(level + warm);
                pixel[1] = static_cast<float>(level);
                pixel[2] = static_cast<float>(level - warm);
            }
        }
    }
    return Image<float>({kWidth, kHeight}, 3, std::move(pixels));
}

Look plain(float red, float green, float blue, float gloss = 0.0F) {
    Look look;
    look.colour = {red, green, blue};
    look.gloss = gloss;
    return look;
}

}  // namespace

int Things::addLook(Look look) {
    looks.push_back(std::move(look));
    return static_cast<int>(looks.size()) - 1;
}

void Things::addSheet(const Vec3& corner, const Vec3& along, const Vec3& up, int look) {
    const Vec3 n = unit(cross(along, up));
    const Vec3 p[4] = {corner, corner + along, corner + along + up, corner + up};
    triangles.push_back({{p[0], p[1], p[2]}, {n, n, n}, {{{0, 0}, {1, 0}, {1, 1}}}, surfaces, look});
    triangles.push_back({{p[0], p[2], p[3]}, {n, n, n}, {{{0, 0}, {1, 1}, {0, 1}}}, surfaces, look});
    ++surfaces;
}

void Things::addBox(const Vec3& foot, const Vec3& size, double turn_deg, int look) {
    const double turn = turn_deg * kPi / 180.0;
    const Vec3 x = size.x * Vec3{std::cos(turn), std::sin(turn), 0},
               y = size.y * Vec3{-std::sin(turn), std::cos(turn), 0};
    const Vec3 z{0, 0, size.z};
    const Vec3 low = foot - 0.5 * x - 0.5 * y;
    addSheet(low + z, x, y, look);
    addSheet(low, x, z, look);
    addSheet(low + x, y, z, look);
    addSheet(low + x + y, -1.0 * x, z, look);
    addSheet(low + y, -1.0 * y, z, look);
}

void Things::addBall(const Vec3& centre, double radius, int look) {
    constexpr int kAround = 96, kDown = 48;
    const auto at = [&](int i, int j) {
        const double a = 2.0 * kPi * i / kAround, b = kPi * j / kDown;
        return Vec3{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)};
    };
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        triangles.push_back(
            {{centre + radius * a, centre + radius * b, centre + radius * c}, {a, b, c}, {}, surfaces, look});
    };
    for (int j = 0; j < kDown; ++j) {
        for (int i = 0; i < kAround; ++i) {
            if (j > 0) add(at(i, j), at(i + 1, j), at(i, j + 1));
            if (j + 1 < kDown) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    ++surfaces;
}

void Things::addRod(const Vec3& from, const Vec3& to, double radius, int look) {
    constexpr int kAround = 24;
    const Vec3 along = unit(to - from);
    const Vec3 side = unit(cross(along, std::abs(along.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
    const Vec3 other = cross(along, side);
    for (int i = 0; i < kAround; ++i) {
        const double a = 2.0 * kPi * i / kAround, b = 2.0 * kPi * (i + 1) / kAround;
        const Vec3 m = std::cos(a) * side + std::sin(a) * other, n = std::cos(b) * side + std::sin(b) * other;
        const Vec3 p[4] = {from + radius * m, to + radius * m, to + radius * n, from + radius * n};
        triangles.push_back({{p[0], p[1], p[2]}, {m, m, n}, {}, surfaces, look});
        triangles.push_back({{p[0], p[2], p[3]}, {m, n, n}, {}, surfaces, look});
    }
    ++surfaces;
    addBall(from, radius, look);
    addBall(to, radius, look);
}

Things deskThings() {
    Things things;
    Look sheet = plain(0.95F, 0.95F, 0.95F);
    sheet.texture = printedSheet();
    const int printed = things.addLook(sheet), wood = things.addLook(plain(0.46F, 0.36F, 0.27F));
    const int card = things.addLook(plain(0.74F, 0.70F, 0.62F)), teal = things.addLook(plain(0.30F, 0.55F, 0.55F));
    const int ball = things.addLook(plain(0.72F, 0.45F, 0.38F, 0.05F));
    things.addSheet({-0.70, -0.55, -0.002}, {1.40, 0, 0}, {0, 1.20, 0}, wood);
    things.addSheet({-0.36, -0.28, 0.0}, {0.72, 0, 0}, {0, 0.56, 0}, printed);
    things.addBox({-0.16, 0.06, 0.0}, {0.13, 0.09, 0.06}, 20.0, card);
    things.addBox({0.14, 0.09, 0.0}, {0.08, 0.07, 0.12}, -15.0, teal);
    things.addBall({0.03, -0.10, 0.045}, 0.045, ball);
    return things;
}

Placed boardPose(int pose) {
    // How it is held: middle of the board (m), turned about its own height, its width and its normal (degrees). It is
    // seen from the camera under 20 to 45 degrees, nearer and farther, in all parts of the view.
    struct Held {
        double x, y, z, yaw, pitch, roll;
    };
    constexpr Held kHeld[kBoardPoses] = {
        {0.00, 0.00, 0.10, 0, 0, 0},      {0.00, 0.00, 0.14, 28, 4, 3},     {0.01, 0.01, 0.13, -30, 2, -5},
        {0.00, -0.01, 0.12, 2, 26, 4},    {-0.01, 0.00, 0.15, -3, -28, 8},  {-0.05, 0.02, 0.14, 22, 20, -12},
        {0.05, -0.06, 0.16, -22, 18, 14}, {0.05, 0.04, 0.07, 20, -22, 20},  {-0.05, -0.03, 0.18, -24, -18, -18},
        {0.00, -0.06, 0.16, 12, -14, 30}, {0.03, 0.00, 0.13, -14, 14, -28}, {-0.03, -0.02, 0.10, 34, -8, 6}};
    const Held& held = kHeld[std::clamp(pose, 1, kBoardPoses) - 1];
    // Turned to whoever sits before the desk and looks down at 43 degrees, then as it is held.
    Placed board;
    board.ahead = unit(Vec3{0.0, 0.74, -0.68});
    board.right = {1, 0, 0};
    board.down = cross(board.ahead, board.right);
    board = nudged(board, {}, held.yaw, held.pitch);
    const double roll = held.roll * kPi / 180.0;
    const Vec3 right = board.right, down = board.down;
    board.right = std::cos(roll) * right + std::sin(roll) * down;
    board.down = std::cos(roll) * down - std::sin(roll) * right;
    const double width = kBoardAcross * kBoardSquare_m, height = kBoardDown * kBoardSquare_m;
    board.at = Vec3{held.x, held.y, held.z} - 0.5 * width * board.right - 0.5 * height * board.down;
    return board;
}

void addBoard(Things& things, const Placed& at) {
    constexpr double kMargin = 0.02, kPaper = 2e-4;
    const double width = kBoardAcross * kBoardSquare_m, height = kBoardDown * kBoardSquare_m;
    Look squares = plain(0.78F, 0.78F, 0.78F);
    squares.squaresAcross = kBoardAcross;
    squares.squaresDown = kBoardDown;
    const int printed = things.addLook(squares), plate = things.addLook(plain(0.78F, 0.78F, 0.78F));
    const Vec3 behind = at.at + kPaper * at.ahead;
    things.addSheet(at.at, width * at.right, height * at.down, printed);
    things.addSheet(behind - kMargin * at.right - kMargin * at.down, (width + 2 * kMargin) * at.right,
                    (height + 2 * kMargin) * at.down, plate);
}

void addHand(Things& things, const Vec3& palm) {
    const int skin = things.addLook(plain(0.72F, 0.50F, 0.42F));
    things.addRod(palm + Vec3{0.0, -0.45, 0.05}, palm, 0.03, skin);
    things.addBox(palm - Vec3{0, -0.03, 0.015}, {0.085, 0.09, 0.028}, 0.0, skin);
    for (int finger = 0; finger < 4; ++finger) {
        const double x = -0.033 + 0.022 * finger;
        things.addRod(palm + Vec3{x, 0.07, 0.0}, palm + Vec3{1.5 * x, 0.15 - 20.0 * x * x, -0.02}, 0.009, skin);
    }
    things.addRod(palm + Vec3{-0.04, 0.0, 0.0}, palm + Vec3{-0.085, 0.06, -0.01}, 0.011, skin);
}

}  // namespace ilf::devices::scene
