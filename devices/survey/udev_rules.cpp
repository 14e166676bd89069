#include "devices/survey/udev_rules.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "udev_rules_text.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "70-illuminatedfocus.rules";
constexpr const char* kFile = "/etc/udev/rules.d/70-illuminatedfocus.rules";
constexpr const char* kReload = "udevadm control --reload";
constexpr const char* kTrigger = "udevadm trigger --action=change --subsystem-match=usb --subsystem-match=tty";

std::string reason() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

/// Through a file beside it, whose name udev passes over, so that udev never reads half of it.
Result<void> written(const fs::path& file, const std::string& text) {
    std::string beside = (file.parent_path() / ".illuminatedfocus-XXXXXX").string();
    const auto refused = [&]() {
        return fail(Fault::cannotWrite, "\"" + file.string() + "\" cannot be written (" + reason() +
                                            "). Run this as root, on a system whose /etc can be written.");
    };
    const int descriptor = mkstemp(beside.data());
    if (descriptor < 0) return refused();
    const bool whole = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       fchmod(descriptor, 0644) == 0 && fsync(descriptor) == 0;
    const int why = errno;
    close(descriptor);
    if (whole && rename(beside.c_str(), file.c_str()) == 0) return {};
    if (!whole) errno = why;
    const auto error = refused();
    unlink(beside.c_str());
    return error;
}

/// An administrator may have put rules of their own there, or a link to /dev/null that switches them off.
bool areOurs(const fs::path& file) {
    std::error_code none;
    const std::string rules = udevRules();
    return fs::is_regular_file(fs::symlink_status(file, none)) && firstLine(file) == rules.substr(0, rules.find('\n'));
}

std::string folderOfUdevadm(const SystemPlaces& places) {
    for (const char* folder : {"usr/bin", "bin", "usr/sbin", "sbin"})
        if (std::error_code none; fs::exists(places / folder / "udevadm", none)) return folder;
    return {};
}

/// Its system is the one that runs now.
bool isThisSystem(const SystemPlaces& places) { return places.root == "/"; }

bool ran(const std::string& command) { return std::system(command.c_str()) == 0; }  // NOLINT(concurrency-mt-unsafe)

}  // namespace

std::string udevRules() { return kUdevRulesText; }

InstalledRules installedRules(const SystemPlaces& places) {
    for (const char* folder : {"etc/udev/rules.d", "run/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d"}) {
        const fs::path file = places / folder / kName;
        std::error_code none;
        if (!fs::exists(fs::symlink_status(file, none))) continue;
        std::ifstream in(file);
        return {file, std::string(std::istreambuf_iterator<char>(in), {}) == udevRules(), areOurs(file)};
    }
    return {};
}

std::string installCommand() {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    return "sudo " + shellWord(none ? std::string("illuminatedfocus") : program.string()) + " doctor --install-rules";
}

std::string rulesByHand() {
    return "  " + installCommand() + "\n\nor, by hand:\n\nsudo tee " + kFile + " >/dev/null <<'END'\n" + udevRules() +
           "END\nsudo " + kReload + "\nsudo " + kTrigger + "\n";
}

Result<std::vector<std::string>> installRules(const SystemPlaces& places) {
    const fs::path folder = places / "etc/udev/rules.d", file = folder / kName;
    std::vector<std::string> done;
    if (const InstalledRules now = installedRules(places); now.same && now.file == file) {
        done.push_back("The rules in " + file.string() + " are already those of this version.");
    } else {
        std::error_code error;
        if (fs::exists(fs::symlink_status(file, error)) && !areOurs(file))
            return fail(Fault::cannotWrite, "\"" + file.string() +
                                                "\" was written by somebody else, or switches these rules off, so it "
                                                "was left as it is. Ask who wrote it, move it away, then run this "
                                                "again.");
        fs::create_directories(folder, error);
        if (error)
            return fail(Fault::cannotWrite, "\"" + folder.string() + "\" cannot be made (" + error.message() +
                                                "). Run this as root, on a system whose /etc can be written.");
        if (const auto ok = written(file, udevRules()); !ok) return tl::unexpected(ok.error());
        done.push_back("Wrote " + file.string() + ".");
    }
    const std::string udevadm = folderOfUdevadm(places);
    if (udevadm.empty()) {
        done.emplace_back("udevadm is not on this system, so nothing was reloaded: restart the machine.");
    } else if (!isThisSystem(places)) {
        done.emplace_back("That is not the system that runs now, so udev was not told.");
    } else if (ran("/" + udevadm + "/" + kReload) && ran("/" + udevadm + "/" + kTrigger)) {
        done.emplace_back("udev has read them and looked at what is plugged in. If a device still may not be opened, "
                          "unplug it and plug it in again.");
    } else {
        done.emplace_back("udev could not be told (does it run? in a container it does not): restart the machine, or "
                          "the container's host.");
    }
    return done;
}

}  // namespace ilf::devices
