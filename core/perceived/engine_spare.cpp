#include "core/perceived/engine_spare.h"

#include <mutex>
#include <utility>
#include <vector>

namespace ilf::view {

struct SpareTiles::Store {
    std::mutex mutex;
    std::vector<std::unique_ptr<SpareTile>> tiles;
};

SpareTiles::SpareTiles() : store_(std::make_shared<Store>()) {}

std::unique_ptr<SpareTile> SpareTiles::take() {
    {
        const std::scoped_lock lock(store_->mutex);
        if (!store_->tiles.empty()) {
            auto tile = std::move(store_->tiles.back());
            store_->tiles.pop_back();
            return tile;
        }
    }
    return std::make_unique<SpareTile>();
}

Box<ViewTile> SpareTiles::boxed(std::unique_ptr<SpareTile> tile) {
    return Box<ViewTile>(std::shared_ptr<const ViewTile>(tile.release(), [store = store_](const ViewTile* gone) {
        // Made above as one that may change.
        std::unique_ptr<SpareTile> back(static_cast<SpareTile*>(const_cast<ViewTile*>(gone)));
        const std::scoped_lock lock(store->mutex);
        store->tiles.push_back(std::move(back));
    }));
}

}  // namespace ilf::view
