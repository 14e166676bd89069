#include "app/studio/marks_show.h"

#include <chrono>
#include <exception>
#include <utility>

#include "devices/scan/core_show.h"

namespace ilf::app {
namespace {

constexpr std::chrono::milliseconds kLook{30};

std::string shownUntilEnd(Latest<Image<std::uint8_t>>& pictures, devices::CoreShow& show, const std::stop_token& stop) {
    bool any = false;
    while (!stop.stop_requested()) {
        if (const auto picture = pictures.tryTake()) {
            if (const auto shown = show.show(*picture); !shown) return shown.error().what;
            any = true;
        }
        if (!any) {
            std::this_thread::sleep_for(kLook);
        } else if (const auto held = show.hold(kLook); !held) {
            return held.error().what;
        }
    }
    return {};
}

}  // namespace

MarksShow::MarksShow(std::filesystem::path runtimeDirectory, Rig rig, Dioptre rest, std::function<void()> onNews)
    : thread_([this, directory = std::move(runtimeDirectory), rig = std::move(rig), rest,
               onNews = std::move(onNews)](const std::stop_token& stop) {
          devices::CoreShow show(directory, rig, rest, stop);
          std::string why;
          try {
              why = shownUntilEnd(pictures_, show, stop);
          } catch (const std::exception& e) {
              why = std::string("Showing marks stopped by an unexpected failure: ") + e.what();
          }
          show.safe();
          if (why.empty()) return;
          ended_.put(why);
          if (onNews) onNews();
      }) {}

}  // namespace ilf::app
