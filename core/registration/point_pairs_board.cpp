#include <algorithm>
#include <cmath>

#include "core/registration/point_pairs.h"

namespace ilf {

namespace {

/// 10 x 7 squares: turned by half a turn, the first corner's square has the other colour.
constexpr int kColumns = 10, kRows = 7;
/// White around the squares, which finders look for, as a share of the raster.
constexpr double kFilled = 0.88;
/// Sum of both pictures below which a pixel does not see the projector.
constexpr int kTooDark = 8;

struct Squares {
    int side = 0, x0 = 0, y0 = 0;
};

Squares squaresOn(Size projector) {
    const int side =
        static_cast<int>(std::min(kFilled * projector.width / kColumns, kFilled * projector.height / kRows));
    return {side, (projector.width - kColumns * side) / 2, (projector.height - kRows * side) / 2};
}

bool black(int column, int row) { return (column + row) % 2 == 0; }

/// White where the first picture is the brighter one, black where the second is: what both have in common (the scene's
/// colours, other light) is gone.
Image<std::uint8_t> difference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
    std::vector<std::uint8_t> pixels(a.pixels().size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const int first = a.pixels()[i], second = b.pixels()[i], sum = first + second;
        const double share = sum < kTooDark ? 1.0 : static_cast<double>(first - second) / sum;
        pixels[i] = static_cast<std::uint8_t>(std::clamp(128.0 + 127.0 * share, 0.0, 255.0));
    }
    return {a.size(), 1, std::move(pixels)};
}

/// Positive when squares are black and white as projected, negative when the corners begin at the board's other end.
double likeness(const Image<std::uint8_t>& picture, const std::vector<Point<CameraFrame>>& corners,
                const Board& board) {
    double sum = 0.0;
    for (int row = 0; row + 1 < board.rows; ++row) {
        for (int column = 0; column + 1 < board.columns; ++column) {
            const auto at = static_cast<std::size_t>(row * board.columns + column);
            const auto below = at + static_cast<std::size_t>(board.columns);
            const double x = 0.25 * (corners[at].x + corners[at + 1].x + corners[below].x + corners[below + 1].x);
            const double y = 0.25 * (corners[at].y + corners[at + 1].y + corners[below].y + corners[below + 1].y);
            const double value = picture.at(std::clamp(static_cast<int>(x), 0, picture.width() - 1),
                                            std::clamp(static_cast<int>(y), 0, picture.height() - 1));
            sum += (black(column + 1, row + 1) ? 128.0 - value : value - 128.0);
        }
    }
    return sum;
}

}  // namespace

ProjectedBoard projectedBoard(Size projector) {
    const Squares squares = squaresOn(projector);
    ProjectedBoard out;
    out.board = {kColumns - 1, kRows - 1, 1.0_m};  // its size in the room depends on the surface
    for (int row = 1; row < kRows; ++row) {
        for (int column = 1; column < kColumns; ++column) {
            out.corners.push_back({static_cast<double>(squares.x0 + column * squares.side),
                                   static_cast<double>(squares.y0 + row * squares.side)});
        }
    }
    return out;
}

Image<std::uint8_t> projectedBoardPicture(Size projector, bool inverse) {
    const Squares squares = squaresOn(projector);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(projector.width) * static_cast<std::size_t>(projector.height));
    for (int y = 0; y < projector.height; ++y) {
        for (int x = 0; x < projector.width; ++x) {
            const int u = x - squares.x0, v = y - squares.y0;
            const bool inside = u >= 0 && v >= 0 && u < kColumns * squares.side && v < kRows * squares.side;
            const bool dark = inside && black(u / squares.side, v / squares.side);
            pixels.push_back(dark != inverse ? 0 : 255);
        }
    }
    return {projector, 1, std::move(pixels)};
}

Result<PairedRegistration> registeredByBoard(const Image<std::uint8_t>& seen, const Image<std::uint8_t>& seenInverse,
                                             Size projector) {
    if (seen.empty() || seen.size() != seenInverse.size() || seen.channels() != 1 || seenInverse.channels() != 1) {
        return fail(Fault::badFile, "The pictures of the projected chessboard and of its inverse must be grey and of "
                                    "one size.");
    }
    const ProjectedBoard projected = projectedBoard(projector);
    const Image<std::uint8_t> picture = difference(seen, seenInverse);
    auto corners = boardCorners(picture, projected.board, "The projected chessboard");
    if (!corners && corners.error().fault == Fault::notFound) {
        return fail(Fault::notFound,
                    "The chessboard that the projector shows is not seen whole. It fills the raster: the "
                    "camera must see all of the projector's light, on one flat, even surface with "
                    "nothing before it; else scan, or click pairs.");
    }
    if (!corners) return tl::unexpected(corners.error());
    if (likeness(picture, *corners, projected.board) < 0.0) std::ranges::reverse(*corners);
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < corners->size(); ++i)
        pairs.push_back({(*corners)[i], projected.corners[i]});
    return registeredByPairs(pairs, seen.size(), projector).map([](PairedRegistration registration) {
        registration.registration.method = Registration::Method::chessboard;
        return registration;
    });
}

}  // namespace ilf
