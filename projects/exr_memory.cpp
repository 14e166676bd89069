#include "projects/exr_memory.h"

#include <cstring>
#include <stdexcept>

namespace ilf::projects {

void ExrBytes::write(const char c[], int n) {
    const auto count = static_cast<std::size_t>(n);
    if (at_ + count > bytes.size()) bytes.resize(at_ + count);
    bytes.replace(at_, count, c, count);
    at_ += count;
}

bool ExrReading::read(char c[], int n) {
    const auto count = static_cast<std::size_t>(n);
    if (n < 0 || bytes_.size() - at_ < count) throw std::runtime_error("it ends too early");
    std::memcpy(c, bytes_.data() + at_, count);
    at_ += count;
    return at_ < bytes_.size();
}

void ExrReading::seekg(std::uint64_t position) {
    if (position > bytes_.size()) throw std::runtime_error("it points beyond its end");
    at_ = static_cast<std::size_t>(position);
}

}  // namespace ilf::projects
