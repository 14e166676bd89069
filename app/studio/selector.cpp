#include "app/studio/selector.h"

namespace ilf::app {

Selector::Selector(std::function<void()> onFound)
    : onFound_(std::move(onFound)), thread_([this](std::stop_token stop) { run(stop); }) {}

void Selector::find(Box<Picture> picture, Task task) {
    pending_ = 1;  // a newer click replaces one that has not begun
    jobs_.put({std::move(picture), std::move(task)});
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
            selection.mask = flooded(*job->picture, flood.at, flood.tolerance);
        }
        found_.put(std::move(selection));
        onFound_();
    }
}

}  // namespace ilf::app
