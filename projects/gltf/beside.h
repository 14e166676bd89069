// The bytes that a glTF file names: data URIs, and files beneath its own folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace ilf::projects::gltf {

/// What a URI gives, or why it gives nothing, to be read after the member's name: `names "x.bin", which is not there`.
using Bytes = tl::expected<std::string, std::string>;

class Beside {
public:
    explicit Beside(const std::filesystem::path& gltf);

    /// Of a buffer: a data URI of one of glTF's two kinds, or a file.
    Bytes buffer(const std::string& uri) const;
    /// Of an image: a data URI of any kind, or a file.
    Bytes image(const std::string& uri) const;

private:
    Bytes file(const std::string& uri) const;
    std::filesystem::path folder_;
};

}  // namespace ilf::projects::gltf
