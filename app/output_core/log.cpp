#include "app/output_core/log.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "devices/link/runtime_directory.h"

namespace ilf::app {

void startLog(const std::string& role) {
    constexpr std::size_t kBytes = 5'000'000, kFiles = 10;
    try {
        const auto file = devices::stateDirectory() / (role + ".log");
        spdlog::set_default_logger(spdlog::rotating_logger_mt(role, file.string(), kBytes, kFiles));
    } catch (const spdlog::spdlog_ex& error) {
        spdlog::set_default_logger(spdlog::stderr_logger_mt(role));
        spdlog::warn("no log file: {}", error.what());
    }
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %n[%P] %v");
    // What is written just before a kill is what one wants to read.
    spdlog::flush_on(spdlog::level::info);
}

}  // namespace ilf::app
