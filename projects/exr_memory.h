// OpenEXR files in memory, so that they can be put in place, or judged, as a whole.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace ilf::projects {

/// What the library writes.
class ExrBytes final : public Imf::OStream {
public:
    ExrBytes() : Imf::OStream("EXR") {}
    void write(const char c[], int n) override;
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

    std::string bytes;

private:
    std::size_t at_ = 0;
};

/// What it reads; `bytes` must outlive it. A file that ends too early throws a runtime_error that ends a sentence.
class ExrReading final : public Imf::IStream {
public:
    ExrReading(std::string_view bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
    bool read(char c[], int n) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override;

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace ilf::projects
