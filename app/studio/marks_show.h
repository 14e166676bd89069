// Keeps a picture on the projector for an operator to point at, on a thread of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "core/base/image.h"
#include "core/base/latest.h"
#include "core/document/rig.h"

namespace ilf::app {

/// Its end is steady white light, for which it waits. While it lives nobody else may send to the core; safe light that
/// somebody asks for ends it.
class MarksShow {
public:
    /// `onNews` is called from the thread once `ended` has something.
    MarksShow(std::filesystem::path runtimeDirectory, Rig rig, Dioptre rest, std::function<void()> onNews);
    MarksShow(const MarksShow&) = delete;
    MarksShow& operator=(const MarksShow&) = delete;

    void show(Image<std::uint8_t> picture) { pictures_.put(std::move(picture)); }
    /// Why nothing is shown any more; once.
    std::optional<std::string> ended() { return ended_.tryTake(); }

private:
    Latest<Image<std::uint8_t>> pictures_;
    Latest<std::string> ended_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
