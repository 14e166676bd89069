#include "app/output_core/log.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "app/output_core/events.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {

void startLog(const std::string& role) {
    constexpr std::size_t kBytes = 5'000'000, kFiles = 10;
    std::string trouble;
    try {
        const auto file = devices::stateDirectory() / (role + ".log");
        spdlog::set_default_logger(spdlog::rotating_logger_mt(role, file.string(), kBytes, kFiles));
    } catch (const spdlog::spdlog_ex& error) {
        spdlog::set_default_logger(spdlog::stderr_logger_mt(role));
        trouble = error.what();
    }
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %n[%P] %v");
    // What is written just before a kill is what one wants to read.
    spdlog::flush_on(spdlog::level::info);
    if (!trouble.empty()) note(event::kNoLogFile, trouble);
}

void note(const Event& event, const std::string& detail) {
    constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::info, spdlog::level::warn, spdlog::level::err};
    const auto level = kLevels[static_cast<std::size_t>(event.weight)];
    if (detail.empty())
        spdlog::log(level, "E-{} {}", event.number, event.sentence);
    else
        spdlog::log(level, "E-{} {}: {}", event.number, event.sentence, detail);
}

}  // namespace ilf::app
