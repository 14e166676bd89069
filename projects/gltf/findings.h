// What is wrong with a glTF file, gathered while it is checked: refusals and remarks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace ilf::projects::gltf {

/// Limits of what is read: a scene on a desk or of a room stays far below.
inline constexpr std::size_t kMaxBytes = std::size_t{1} << 30U;
inline constexpr std::size_t kMaxVertices = 20'000'000;
inline constexpr std::size_t kMaxTriangles = 20'000'000;
inline constexpr std::size_t kMaxDepth = 100;  ///< of nested JSON

class Findings {
public:
    /// Something the file must not have; `where` as in "accessors[3].count". The first is what the operator reads.
    void refuse(const std::string& where, const std::string& what) {
        if (refusals_++ == 0) first_ = where.empty() ? what : where + " " + what;
    }
    /// Something that was repaired, ignored or is not drawn. The same sentence is kept once.
    void remark(std::string sentence) {
        for (const std::string& known : remarks_) {
            if (known == sentence) return;
        }
        if (remarks_.size() < kMostRemarks) remarks_.push_back(std::move(sentence));
    }

    bool sound() const { return refusals_ == 0; }
    /// Precondition: not sound(). `file` as sentences show it.
    tl::unexpected<Error> error(const std::string& file, const std::string& help) const {
        std::string what = file + " is no sound glTF file: " + first_ + ".";
        if (refusals_ > 1)
            what += " (" + std::to_string(refusals_ - 1) + (refusals_ == 2 ? " more is" : " more are") + " wrong.)";
        return fail(Fault::badFile, what + " " + help);
    }
    std::vector<std::string> takeRemarks() { return std::move(remarks_); }

private:
    static constexpr std::size_t kMostRemarks = 50;
    std::size_t refusals_ = 0;
    std::string first_;
    std::vector<std::string> remarks_;
};

}  // namespace ilf::projects::gltf
