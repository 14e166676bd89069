// Click-select on a thread of its own: the answer comes as a mask edit.
#pragma once

#include <functional>
#include <optional>
#include <thread>
#include <variant>

#include "core/base/latest.h"
#include "core/document/document.h"
#include "core/document/select.h"
#include "ui/request.h"

namespace ilf::app {

/// What was found, to be united with the region's mask as it is when it arrives.
struct Selection {
    RegionId region;
    Result<Mask> mask;
};

class Selector {
public:
    explicit Selector(std::function<void()> onFound);

    using Task = std::variant<ui::SelectObject, ui::SelectFlood>;
    void find(const Scene& scene, Task task);
    std::optional<Selection> tryTake();
    bool busy() const { return pending_ > 0; }

private:
    struct Job {
        Box<Picture> picture;
        Box<DepthMap> depth;
        Task task;
    };
    void run(std::stop_token stop);

    int pending_ = 0;  ///< main thread only
    std::function<void()> onFound_;
    Latest<Job> jobs_;
    Latest<Selection> found_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
