// Runs one of our programs and keeps what it printed, for tests of the command line.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <sys/wait.h>

namespace ilf {

struct Ran {
    int code = -1;
    std::string out;  ///< standard output; with "2>&1" in the arguments also standard error
};

/// `arguments` goes through the shell; `environment` such as "A=b C=d" is put before the program.
inline Ran runProgram(const std::string& program, const std::string& arguments, const std::string& environment = "") {
    Ran ran;
    const std::string command =
        (environment.empty() ? "" : "env " + environment + " ") + "'" + program + "' " + arguments;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return ran;
    std::array<char, 4096> buffer;
    for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        ran.out.append(buffer.data(), n);
    const int status = pclose(pipe);
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return ran;
}

/// What a person would read, both streams in one; of a run with --json what a program would: standard output alone,
/// since a sanitizer may have something to say, too.
inline Ran readAsCalled(const std::string& program, const std::string& arguments, const std::string& environment = "") {
    const bool byProgram = arguments.find("--json") != std::string::npos;
    return runProgram(program, arguments + (byProgram ? "" : " 2>&1"), environment);
}

/// A new directory under the system's temporary one, removed with all in it when it goes out of scope.
class TemporaryDirectory {
public:
    TemporaryDirectory() {
        std::string name = "/tmp/ilf-test-XXXXXX";
        path_ = mkdtemp(name.data()) != nullptr ? name : std::string();
    }
    ~TemporaryDirectory() {
        if (!path_.empty()) (void)std::system(("rm -rf '" + path_ + "'").c_str());
    }
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

}  // namespace ilf
