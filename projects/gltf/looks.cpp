#include "projects/gltf/looks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/parallel.h"
#include "projects/gltf/checker.h"
#include "projects/gltf/model.h"
#include "projects/picture_header.h"

namespace ilf::projects::gltf {

namespace {

using nlohmann::json;

/// An image that some base colour uses.
struct Used {
    std::string name, bytes, problem;
    Image<std::uint8_t> pixels;
};

/// Through tinygltf's own loader (stb), which gives RGBA of 8 or 16 bits.
void decode(Used& image, int index) {
    const auto header = pictureHeader(image.bytes);
    if (!header || (header->kind != PictureHeader::Kind::png && header->kind != PictureHeader::Kind::jpeg)) {
        image.problem = "is neither PNG nor JPEG";
    } else if (header->tooLarge) {
        image.problem = "has more than 100 megapixels";
    } else if (header->truncated) {
        image.problem = "ends early";
    }
    if (!image.problem.empty()) return;
    tinygltf::Image decoded;
    std::string error, warning;
    const bool good = tinygltf::LoadImageData(&decoded, index, &error, &warning, 0, 0,
                                              reinterpret_cast<const unsigned char*>(image.bytes.data()),
                                              static_cast<int>(image.bytes.size()), nullptr);
    const auto count =
        static_cast<std::size_t>(std::max(decoded.width, 0)) * static_cast<std::size_t>(std::max(decoded.height, 0));
    const auto channels = static_cast<std::size_t>(std::max(decoded.component, 0));
    const std::size_t bytes = decoded.bits == 16 ? 2 : 1;
    if (!good || count == 0 || channels < 3 || decoded.image.size() < count * channels * bytes) {
        image.problem = "is damaged";
        return;
    }
    std::vector<std::uint8_t> rgb(count * 3);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c)  // of 16 bits (little-endian) the upper ones
            rgb[3 * i + c] = decoded.image[(i * channels + c) * bytes + (bytes - 1)];
    }
    image.pixels = Image<std::uint8_t>({decoded.width, decoded.height}, 3, std::move(rgb));
}

Bytes bytesOfImage(const json& image, const tinygltf::Model& model, const Beside& beside) {
    if (image.contains("uri")) return beside.image(image["uri"].get<std::string>());
    const auto bytes = bytesOf(model, static_cast<int>(wholeOf(image["bufferView"]).value_or(0)));
    if (!bytes) return tl::unexpected<std::string>("lies in a buffer whose bytes the file does not name");
    return std::string(bytes->begin(), bytes->end());
}

Material::Wrap wrapOf(int code) {
    return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Material::Wrap::clamp
           : code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Material::Wrap::mirror
                                                           : Material::Wrap::repeat;
}

double numberAt(const tinygltf::Value& list, std::size_t i) {
    return list.Get(static_cast<int>(i)).GetNumberAsDouble();
}

}  // namespace

std::vector<Box<Material>> materialsOf(const json& root, const tinygltf::Model& model, const Beside& beside,
                                       bool textures, Findings& findings) {
    std::map<int, Used> used;
    const auto imageOf = [&](const tinygltf::Material& material) {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        return texture < 0 ? -1 : model.textures[static_cast<std::size_t>(texture)].source;
    };
    for (const tinygltf::Material& material : model.materials) {
        const int image = imageOf(material);
        if (textures && image >= 0) used[image];
    }
    std::vector<Used*> all;
    for (auto& [index, image] : used) {
        const json& said = root["images"][static_cast<std::size_t>(index)];
        image.name = "images[" + std::to_string(index) + "]";
        if (auto bytes = bytesOfImage(said, model, beside)) {
            image.bytes = std::move(*bytes);
        } else {
            image.problem = bytes.error();
        }
        all.push_back(&image);
    }
    parallelFor(static_cast<int>(all.size()), [&](int i) {
        Used& image = *all[static_cast<std::size_t>(i)];
        if (image.problem.empty()) decode(image, i);
    });
    for (const Used* image : all) {
        if (!image->problem.empty())
            findings.remark(image->name + " " + image->problem + "; what it lies on is drawn in its plain colour.");
    }

    std::vector<Box<Material>> materials;
    for (std::size_t i = 0; i < model.materials.size(); ++i) {
        const tinygltf::Material& from = model.materials[i];
        Material material;
        for (std::size_t c = 0; c < 3; ++c)
            material.colour[c] = static_cast<float>(std::clamp(from.pbrMetallicRoughness.baseColorFactor[c], 0.0, 1.0));
        material.doubleSided = from.doubleSided;
        const int image = imageOf(from);
        if (image >= 0 && used.contains(image)) {
            const auto& texture =
                model.textures[static_cast<std::size_t>(from.pbrMetallicRoughness.baseColorTexture.index)];
            material.texture = used[image].pixels;
            if (texture.sampler >= 0) {
                const auto& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
                material.wrap = {wrapOf(sampler.wrapS), wrapOf(sampler.wrapT)};
            }
        }
        if (from.alphaMode != "OPAQUE")
            findings.remark("Transparent materials are drawn as if nothing were seen through them.");
        materials.emplace_back(std::move(material));
    }
    return materials;
}

std::array<float, 2> TextureLie::operator()(float u, float v) const {
    const double x = scale[0] * static_cast<double>(u), y = scale[1] * static_cast<double>(v);
    const double c = std::cos(rotation), s = std::sin(rotation);
    return {static_cast<float>(offset[0] + c * x + s * y), static_cast<float>(offset[1] - s * x + c * y)};
}

TextureLie textureLie(const tinygltf::Material& material) {
    const auto& info = material.pbrMetallicRoughness.baseColorTexture;
    TextureLie lie;
    lie.set = info.texCoord;
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end()) return lie;
    const tinygltf::Value& transform = found->second;
    for (std::size_t i = 0; i < 2; ++i) {
        if (transform.Has("offset")) lie.offset[i] = numberAt(transform.Get("offset"), i);
        if (transform.Has("scale")) lie.scale[i] = numberAt(transform.Get("scale"), i);
    }
    if (transform.Has("rotation")) lie.rotation = transform.Get("rotation").GetNumberAsDouble();
    if (transform.Has("texCoord")) lie.set = transform.Get("texCoord").GetNumberAsInt();
    return lie;
}

}  // namespace ilf::projects::gltf
