#include "app/studio/selector.h"

#include "core/document/select_depth.h"

namespace ilf::app {

Selector::Selector(std::function<void()> onFound)
    : onFound_(std::move(onFound)), thread_([this](std::stop_token stop) { run(stop); }) {}

void Selector::find(const Scene& scene, Task task) {
    pending_ = 1;  // a newer click replaces one that has not begun
    jobs_.put({scene.picture, scene.depth, std::move(task)});
}

std::optional<Selection> Selector::tryTake() {
    auto found = found_.tryTake();
    if (found && !jobs_.waiting()) pending_ = 0;
    return found;
}

void Selector::run(std::stop_token stop) {
    while (const auto job = jobs_.take(stop)) {
        Selection selection{std::visit([](const auto& task) { return task.region; }, job->task), Mask()};
        if (const auto* object = std::get_if<ui::SelectObject>(&job->task)) {
            selection.mask = cutOut(*job->picture, object->box);
        } else {
            const auto& flood = std::get<ui::SelectFlood>(job->task);
            selection.mask = flood.byDepth ? surfaceAt(job->depth ? *job->depth : DepthMap{}, *job->picture, flood.at,
                                                       {flood.tolerance, false})
                                           : flooded(*job->picture, flood.at, flood.tolerance);
        }
        found_.put(std::move(selection));
        onFound_();
    }
}

}  // namespace ilf::app
