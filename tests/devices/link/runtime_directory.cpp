#include "devices/link/runtime_directory.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace ilf::devices {
namespace {

/// Sets an environment variable for the life of the object.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        setenv(name, value, 1);
    }
    ~Environment() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

std::filesystem::path temporary() {
    std::string name = (std::filesystem::temp_directory_path() / "ilf-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    return name;
}

}  // namespace

TEST_CASE("runtime directory: our own variable, then XDG's, then a directory of the user under /tmp") {
    const Environment own("ILF_RUNTIME_DIR", "/a/b");
    CHECK(runtimeDirectory() == "/a/b");
    const Environment none("ILF_RUNTIME_DIR", "");
    const Environment xdg("XDG_RUNTIME_DIR", "/run/user/1");
    CHECK(runtimeDirectory() == "/run/user/1/illuminatedfocus");
    const Environment empty("XDG_RUNTIME_DIR", "");
    CHECK(runtimeDirectory() == "/tmp/illuminatedfocus-" + std::to_string(getuid()));
}

TEST_CASE("runtime directory: made for its owner alone") {
    const auto directory = temporary() / "deep" / "down";
    REQUIRE(prepareRuntimeDirectory(directory));
    struct stat info{};
    REQUIRE(stat(directory.c_str(), &info) == 0);
    CHECK((info.st_mode & 0777U) == 0700U);
    chmod(directory.c_str(), 0755);
    REQUIRE(prepareRuntimeDirectory(directory));
    REQUIRE(stat(directory.c_str(), &info) == 0);
    CHECK((info.st_mode & 0777U) == 0700U);
}

TEST_CASE("runtime directory: a path too long for a socket, or a file in its place, is refused in words") {
    const auto place = temporary();
    const auto tooLong = prepareRuntimeDirectory(place / std::string(120, 'x'));
    REQUIRE_FALSE(tooLong.has_value());
    CHECK(tooLong.error().what.find("too long a path for a socket") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(place / std::string(120, 'x')));
    std::filesystem::create_symlink("/tmp", place / "link");
    CHECK_FALSE(prepareRuntimeDirectory(place / "link").has_value());
}

TEST_CASE("lock: one holder at a time, named while it holds, free when it goes") {
    const auto file = temporary() / "a.lock";
    CHECK_FALSE(FileLock::holder(file).has_value());
    {
        const auto first = FileLock::tryTake(file);
        REQUIRE(first);
        REQUIRE(first->has_value());
        CHECK(FileLock::holder(file) == getpid());
        const auto second = FileLock::tryTake(file);
        REQUIRE(second);
        CHECK_FALSE(second->has_value());
    }
    CHECK_FALSE(FileLock::holder(file).has_value());
    CHECK_FALSE(FileLock::tryTake("/proc/no/such.lock").has_value());
}

}  // namespace ilf::devices
