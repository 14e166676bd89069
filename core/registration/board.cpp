#include "core/registration/board.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/as_text.h"

namespace ilf {

namespace {

/// A mean square distance between neighbours: what pixels are measured against.
double spacingOf(const std::vector<cv::Point2f>& corners, const Board& board) {
    double sum = 0.0;
    int count = 0;
    const auto add = [&](int a, int b) {
        sum += cv::norm(corners[static_cast<std::size_t>(a)] - corners[static_cast<std::size_t>(b)]), ++count;
    };
    for (int row = 0; row < board.rows; ++row) {
        for (int column = 0; column < board.columns; ++column) {
            const int at = row * board.columns + column;
            if (column + 1 < board.columns) add(at, at + 1);
            if (row + 1 < board.rows) add(at, at + board.columns);
        }
    }
    return sum / count;
}

/// A chessboard's corners lie on a homography, but for the lens's bending, which is smooth: each corner lies where its
/// neighbours in the row, or in the column, say, to a fifth of a square.
bool isGrid(const std::vector<cv::Point2f>& corners, const Board& board) {
    const double most = 0.2 * spacingOf(corners, board);
    const auto at = [&](int column, int row) {
        return corners[static_cast<std::size_t>(row * board.columns + column)];
    };
    for (int row = 0; row < board.rows; ++row) {
        for (int column = 0; column < board.columns; ++column) {
            if (column > 0 && column + 1 < board.columns &&
                cv::norm(at(column - 1, row) + at(column + 1, row) - 2.0f * at(column, row)) > 2.0 * most) {
                return false;
            }
            if (row > 0 && row + 1 < board.rows &&
                cv::norm(at(column, row - 1) + at(column, row + 1) - 2.0f * at(column, row)) > 2.0 * most) {
                return false;
            }
        }
    }
    return true;
}

/// The distance to the nearest neighbour in row or column.
double nearestTo(const std::vector<cv::Point2f>& corners, const Board& board, int column, int row) {
    const auto at = [&](int c, int r) { return corners[static_cast<std::size_t>(r * board.columns + c)]; };
    double nearest = 1e9;
    if (column > 0) nearest = std::min(nearest, cv::norm(at(column, row) - at(column - 1, row)));
    if (column + 1 < board.columns) nearest = std::min(nearest, cv::norm(at(column, row) - at(column + 1, row)));
    if (row > 0) nearest = std::min(nearest, cv::norm(at(column, row) - at(column, row - 1)));
    if (row + 1 < board.rows) nearest = std::min(nearest, cv::norm(at(column, row) - at(column, row + 1)));
    return nearest;
}

/// To where edges are at right angles to the way to the corner: finders leave up to half a pixel of error, this a
/// twentieth. Each corner has a window of its own that does not reach the next one: under strong perspective one window
/// for all makes corners of small squares jump (OpenCV's own calibration of left02.jpg is 1.2 px off by that).
void refine(const cv::Mat& picture, std::vector<cv::Point2f>& corners, const Board& board) {
    const std::vector<cv::Point2f> found = corners;
    for (int row = 0; row < board.rows; ++row) {
        for (int column = 0; column < board.columns; ++column) {
            const auto at = static_cast<std::size_t>(row * board.columns + column);
            const double nearest = nearestTo(found, board, column, row);
            const int half = std::clamp(static_cast<int>(0.3 * nearest), 2, 11);
            std::vector<cv::Point2f> corner{found[at]};
            cv::cornerSubPix(picture, corner, cv::Size(half, half), cv::Size(-1, -1),
                             cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-3));
            if (cv::norm(corner[0] - found[at]) < 0.3 * nearest) corners[at] = corner[0];
        }
    }
}

std::vector<cv::Point2f> found(const cv::Mat& picture, const Board& board) {
    const cv::Size corners(board.columns, board.rows);
    std::vector<cv::Point2f> at;
    // The sector-based finder bears strong perspective and blur; where it fails (few pixels a square, borders cut off),
    // the classic one often does not.
    const auto finders = {
        +[](const cv::Mat& p, cv::Size c, std::vector<cv::Point2f>& a) {
            return cv::findChessboardCornersSB(p, c, a, cv::CALIB_CB_NORMALIZE_IMAGE);
        },
        +[](const cv::Mat& p, cv::Size c, std::vector<cv::Point2f>& a) {
            return cv::findChessboardCorners(p, c, a, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
        },
        +[](const cv::Mat& p, cv::Size c, std::vector<cv::Point2f>& a) {
            return cv::findChessboardCornersSB(p, c, a, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE);
        }};
    for (const auto& finder : finders) {
        if (!finder(picture, corners, at)) continue;
        refine(picture, at, board);
        if (isGrid(at, board)) return at;
    }
    return {};
}

/// Turned so that rows follow columns as they do on the print: finders may give them mirrored.
void setRight(std::vector<cv::Point2f>& corners, const Board& board) {
    const cv::Point2f first = corners.front();
    const cv::Point2f along = corners[static_cast<std::size_t>(board.columns) - 1] - first;
    const cv::Point2f down = corners[corners.size() - static_cast<std::size_t>(board.columns)] - first;
    if (along.x * down.y - along.y * down.x > 0.0f) return;
    for (auto row = corners.begin(); row != corners.end(); row += board.columns)
        std::reverse(row, row + board.columns);
}

std::string spokenBoard(const Board& board) {
    return std::to_string(board.columns) + " x " + std::to_string(board.rows);
}

}  // namespace

std::vector<Point3<ModelSpace>> cornersOf(const Board& board) {
    std::vector<Point3<ModelSpace>> corners;
    for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column)
            corners.push_back({column * board.square.si(), row * board.square.si(), 0.0});
    return corners;
}

Result<void> checked(const Board& board) {
    if (board.columns < 3 || board.rows < 3 || board.columns > 100 || board.rows > 100) {
        return fail(Fault::outOfRange, "A chessboard of " + spokenBoard(board) +
                                           " inner corners cannot be used: count the points where black squares meet, "
                                           "3 to 100 each way, such as 9x6.");
    }
    if (!(board.square >= 0.1_mm && board.square <= 10.0_m)) {
        return fail(Fault::outOfRange, "A chessboard's square must be 0.1 mm to 10 m wide: measure one on the print.");
    }
    return {};
}

Result<std::vector<Point<CameraFrame>>> boardCorners(const Image<std::uint8_t>& grey, const Board& board,
                                                     const std::string& name) {
    if (const auto good = checked(board); !good) return tl::unexpected(good.error());
    if (grey.empty() || grey.channels() != 1) {
        return fail(Fault::badFile, name + ": a grey picture is needed to look for the chessboard.");
    }
    const cv::Mat picture(grey.height(), grey.width(), CV_8UC1, const_cast<std::uint8_t*>(grey.pixels().data()));
    try {
        std::vector<cv::Point2f> corners = found(picture, board);
        if (corners.empty()) {
            return fail(Fault::notFound, name + ": no chessboard of " + spokenBoard(board) +
                                             " inner corners is seen. The whole board must be in the picture with a "
                                             "white margin, lit evenly and not glossy; check the two counts as well.");
        }
        setRight(corners, board);
        // OpenCV's pixels have their centres at whole numbers.
        std::vector<Point<CameraFrame>> inCamera;
        for (const cv::Point2f& c : corners)
            inCamera.push_back({c.x + 0.5, c.y + 0.5});
        return inCamera;
    } catch (const cv::Exception& e) {
        return fail(Fault::badFile, name + ": looking for the chessboard failed: " + std::string(e.what()));
    }
}

}  // namespace ilf
