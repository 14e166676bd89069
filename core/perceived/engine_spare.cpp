#include "core/perceived/engine_spare.h"

#include <mutex>
#include <utility>
#include <vector>

namespace ilf::view {

struct SpareTiles::Store {
    std::mutex mutex;
    std::vector<std::unique_ptr<ViewTile>> tiles;
};

SpareTiles::SpareTiles() : store_(std::make_shared<Store>()) {}

std::unique_ptr<ViewTile> SpareTiles::take() {
    {
        const std::scoped_lock lock(store_->mutex);
        if (!store_->tiles.empty()) {
            auto tile = std::move(store_->tiles.back());
            store_->tiles.pop_back();
            return tile;
        }
    }
    return std::make_unique<ViewTile>();
}

Box<ViewTile> SpareTiles::boxed(std::unique_ptr<ViewTile> tile) {
    return Box<ViewTile>(std::shared_ptr<const ViewTile>(tile.release(), [store = store_](const ViewTile* gone) {
        std::unique_ptr<ViewTile> back(const_cast<ViewTile*>(gone));  // made as one that may change
        const std::scoped_lock lock(store->mutex);
        store->tiles.push_back(std::move(back));
    }));
}

}  // namespace ilf::view
