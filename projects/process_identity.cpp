#include "projects/process_identity.h"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace ilf::projects {
namespace {

std::string contentOf(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Clock ticks after boot when a process started (/proc/PID/stat, field 22); empty when it is dead, also when nobody
/// has collected it yet.
std::string startOf(int pid) {
    const std::string stat = contentOf("/proc/" + std::to_string(pid) + "/stat");
    const std::size_t nameEnd = stat.rfind(')');  // the name may hold anything
    if (nameEnd == std::string::npos) return {};
    std::istringstream fields(stat.substr(nameEnd + 1));
    std::string field;
    for (int number = 3; fields >> field; ++number) {
        if (number == 3 && (field == "Z" || field == "X")) return {};
        if (number == 22) return field;
    }
    return {};
}

std::string boot() { return contentOf("/proc/sys/kernel/random/boot_id"); }

int pidOf(const Json& json) {
    JsonReader reader(json, "");
    const int pid = reader.whole("pid");
    return reader.problem() ? 0 : pid;
}

}  // namespace

void signWithProcess(Json& json) {
    json.set("pid", static_cast<int>(::getpid()));
    json.set("process_start_ticks", startOf(::getpid()));
    json.set("boot_id", boot());
}

bool signerLives(const Json& json) {
    const int pid = pidOf(json);
    if (pid <= 0 || json.word("boot_id") != boot()) return false;
    const std::string start = startOf(pid);
    return !start.empty() && start == json.word("process_start_ticks");
}

bool signedByMe(const Json& json) { return pidOf(json) == ::getpid() && signerLives(json); }

}  // namespace ilf::projects
