#include "app/scan/scanner.h"

#include <exception>
#include <utility>

namespace ilf::app {

Scanner::Scanner(ScanWork work, std::function<void()> onNews)
    : thread_([this, work = std::move(work), onNews = std::move(onNews)](const std::stop_token& stop) {
          const auto watch = [&](const devices::ScanProgress& progress) {
              progress_.put(progress);
              onNews();
          };
          try {
              result_.put(work(watch, stop));
          } catch (const std::exception& e) {  // a library threw where nobody expected it
              result_.put(fail(Fault::device, std::string("The scan stopped by an unexpected failure: ") + e.what()));
          }
          onNews();
      }) {}

}  // namespace ilf::app
