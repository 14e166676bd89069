// Tiles of views that nobody looks at any more, to be filled again: fresh memory costs more than to fill it.
#pragma once

#include <memory>

#include "core/perceived/engine_floats.h"
#include "core/perceived/view_engine.h"

namespace ilf::view {

/// Begins on a line of the cache.
struct alignas(AlignedFloats::kAlignment) SpareTile : ViewTile {};

class SpareTiles {
public:
    SpareTiles();
    /// A tile with whatever it held last.
    std::unique_ptr<SpareTile> take();
    /// Comes back here when the last view with it is gone, from any thread; also after this is gone.
    Box<ViewTile> boxed(std::unique_ptr<SpareTile> tile);

private:
    struct Store;
    std::shared_ptr<Store> store_;
};

}  // namespace ilf::view
