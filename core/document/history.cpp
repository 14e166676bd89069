#include "core/document/history.h"

#include <algorithm>
#include <utility>

namespace ilf {

namespace {

std::size_t bytesOf(const Mask& mask, const Mask& before) {
    std::size_t bytes = 0;
    forEachChangedTile(before, mask, [&](int column, int row) {
        const Box<Tile>& tile = mask.tile(column, row);
        if (!tile.same(uniformTile(tile->v[0]))) bytes += sizeof(Tile);
    });
    return bytes + sizeof(Box<Tile>) * static_cast<std::size_t>(mask.columns()) * static_cast<std::size_t>(mask.rows());
}

std::size_t depthBytes(const Image<float>& metres, const Image<float>& sigma) {
    return metres.pixels().size_bytes() + sigma.pixels().size_bytes();
}

/// Bytes of tiles and pictures that `document` holds and `before` does not.
std::size_t bytesNotShared(const Document& document, const Document& before) {
    std::size_t bytes = 0;
    const auto& picture = document.scene.picture;
    if (picture && !picture.same(before.scene.picture)) bytes += picture->pixels().size_bytes();
    const auto& depth = document.scene.depth;
    if (depth && !depth.same(before.scene.depth)) bytes += depthBytes(depth->metres, depth->sigma);
    const auto& measured = document.scene.measured;
    if (measured && !measured.same(before.scene.measured)) bytes += depthBytes(measured->metres, measured->sigma);
    for (const Box<Region>& region : document.regions) {
        const auto earlier = std::find_if(before.regions.begin(), before.regions.end(),
                                          [&](const Box<Region>& r) { return r->id == region->id; });
        if (earlier == before.regions.end()) {
            bytes += bytesOf(region->mask, {});
        } else if (!region.same(*earlier)) {
            bytes += bytesOf(region->mask, (*earlier)->mask);
        }
    }
    return bytes;
}

}  // namespace

History::History(Document first, std::size_t byteLimit) : byteLimit_(byteLimit) {
    steps_.push_back({std::move(first), {}, 0});
}

const Document& History::current() const { return previewing_ ? preview_ : steps_[position_].document; }

void History::preview(Document document) {
    preview_ = std::move(document);
    previewing_ = true;
}

void History::commit(std::string label) {
    if (!previewing_) return;
    if (preview_ == steps_[position_].document) return cancel();
    steps_.resize(position_ + 1);
    bytes_ = 0;
    for (const Step& step : steps_)
        bytes_ += step.bytes;
    const std::size_t bytes = bytesNotShared(preview_, steps_[position_].document);
    steps_.push_back({std::exchange(preview_, {}), std::move(label), bytes});
    previewing_ = false;
    bytes_ += bytes;
    ++position_;
    ++revision_;
    trim();
}

void History::cancel() {
    previewing_ = false;
    preview_ = {};
}

bool History::canUndo() const { return previewing_ || position_ > 0; }
bool History::canRedo() const { return !previewing_ && position_ + 1 < steps_.size(); }

void History::undo() {
    if (previewing_) return cancel();
    if (position_ == 0) return;
    --position_;
    ++revision_;
}

void History::redo() {
    if (!canRedo()) return;
    ++position_;
    ++revision_;
}

std::string History::undoLabel() const { return position_ > 0 ? steps_[position_].label : std::string(); }
std::string History::redoLabel() const { return canRedo() ? steps_[position_ + 1].label : std::string(); }

void History::trim() {
    while (bytes_ > byteLimit_ && position_ > 0) {
        bytes_ -= steps_[1].bytes;
        steps_[1].bytes = 0;  // the oldest step is what the others are counted from
        steps_.erase(steps_.begin());
        --position_;
    }
}

}  // namespace ilf
