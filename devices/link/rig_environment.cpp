#include "devices/link/rig_environment.h"

#include <cassert>
#include <fstream>
#include <system_error>

namespace ilf::devices {

std::filesystem::path rigEnvironmentFile(const std::filesystem::path& runtimeDirectory) {
    return runtimeDirectory / "emulated-rig.env";
}

Result<RigEnvironment> rigEnvironment(const std::filesystem::path& runtimeDirectory) {
    std::ifstream file(rigEnvironmentFile(runtimeDirectory));
    if (!file) return fail(Fault::notFound, "No emulated rig is ready in " + runtimeDirectory.string() + ".");
    RigEnvironment environment;
    for (std::string line; std::getline(file, line);) {
        const auto equals = line.find('=');
        if (equals == std::string::npos || equals == 0)
            return fail(Fault::badFile, rigEnvironmentFile(runtimeDirectory).string() +
                                            " was not written by an emulated rig; stop the output core and start it "
                                            "again.");
        environment[line.substr(0, equals)] = line.substr(equals + 1);
    }
    return environment;
}

Result<void> saveRigEnvironment(const std::filesystem::path& runtimeDirectory, const RigEnvironment& environment) {
    const auto wanted = rigEnvironmentFile(runtimeDirectory);
    auto beside = wanted;
    beside += ".new";
    {
        std::ofstream file(beside, std::ios::trunc);
        for (const auto& [name, value] : environment) {
            assert(name.find_first_of("=\n") == std::string::npos && value.find('\n') == std::string::npos);
            file << name << '=' << value << '\n';
        }
        file.close();
        if (!file) return fail(Fault::cannotWrite, "Writing " + beside.string() + " failed; is the disk full?");
    }
    std::error_code error;
    std::filesystem::rename(beside, wanted, error);
    if (error) return fail(Fault::cannotWrite, "Writing " + wanted.string() + " failed: " + error.message() + ".");
    return {};
}

void removeRigEnvironment(const std::filesystem::path& runtimeDirectory) noexcept {
    std::error_code error;  // not there is as good
    std::filesystem::remove(rigEnvironmentFile(runtimeDirectory), error);
}

}  // namespace ilf::devices
