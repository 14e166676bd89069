#include <nlohmann/json.hpp>

#include "projects/gltf/checks.h"

namespace ilf::projects::gltf {

namespace {

using enum Checked::Need;

void checkTextureInfo(const Checked& owner, const char* member) {
    const auto info = owner.object(member);
    if (!info) return;
    info->reference("index", "textures", required);
    info->whole("texCoord", 0, 1000);
    if (!info->has("extensions")) return;
    const auto extensions = info->object("extensions");
    const auto transform = extensions ? extensions->object("KHR_texture_transform") : std::nullopt;
    if (!transform) return;
    transform->numbers("offset", 2);
    transform->numbers("scale", 2);
    transform->number("rotation");
    transform->whole("texCoord", 0, 1000);
}

void checkMaterial(const Checked& material) {
    if (const auto metal = material.object("pbrMetallicRoughness")) {
        metal->numbers("baseColorFactor", 4);
        metal->number("metallicFactor");
        metal->number("roughnessFactor");
        checkTextureInfo(*metal, "baseColorTexture");
        checkTextureInfo(*metal, "metallicRoughnessTexture");
    }
    for (const char* member : {"normalTexture", "occlusionTexture", "emissiveTexture"})
        checkTextureInfo(material, member);
    material.numbers("emissiveFactor", 3);
    material.flag("doubleSided");
    material.number("alphaCutoff");
    const auto mode = material.text("alphaMode");
    if (mode && *mode != "OPAQUE" && *mode != "MASK" && *mode != "BLEND")
        material.refuse("alphaMode", "must be OPAQUE, MASK or BLEND");
}

void checkImage(const Checked& image) {
    image.text("uri");
    image.reference("bufferView", "bufferViews");
    image.text("mimeType");
    if (image.has("uri") == image.has("bufferView")) image.refuse("must name either a uri or a bufferView");
    if (image.has("bufferView") && !image.has("mimeType")) image.refuse("mimeType", "is missing");
}

void checkCamera(const Checked& camera) {
    const auto type = camera.text("type", required);
    if (!type) return;
    const auto positive = [](const Checked& lens, const char* member, Checked::Need need) {
        const auto value = lens.number(member, need);
        if (value && !(*value > 0.0)) lens.refuse(member, "must be above 0");
    };
    if (*type == "perspective") {
        const auto lens = camera.object("perspective", required);
        if (!lens) return;
        positive(*lens, "yfov", required);
        positive(*lens, "znear", required);
        positive(*lens, "zfar", optional);
        positive(*lens, "aspectRatio", optional);
        if (lens->number("yfov").value_or(1.0) >= 3.14159) lens->refuse("yfov", "must be less than half a turn");
    } else if (*type == "orthographic") {
        const auto lens = camera.object("orthographic", required);
        if (!lens) return;
        for (const char* member : {"xmag", "ymag", "zfar", "znear"})
            lens->number(member, required);
    } else {
        camera.refuse("type", "must be perspective or orthographic");
    }
}

}  // namespace

void checkLooks(const Checked& gltf) {
    gltf.each("materials", optional, [](const Checked& material, std::size_t) { checkMaterial(material); });
    gltf.each("textures", optional, [](const Checked& texture, std::size_t) {
        texture.reference("sampler", "samplers");
        texture.reference("source", "images");
    });
    gltf.each("samplers", optional, [](const Checked& sampler, std::size_t) {
        sampler.oneOf("wrapS", {33071, 33648, 10497});
        sampler.oneOf("wrapT", {33071, 33648, 10497});
        sampler.oneOf("magFilter", {9728, 9729});
        sampler.oneOf("minFilter", {9728, 9729, 9984, 9985, 9986, 9987});
    });
    gltf.each("images", optional, [](const Checked& image, std::size_t) { checkImage(image); });
    gltf.each("cameras", optional, [](const Checked& camera, std::size_t) { checkCamera(camera); });
}

}  // namespace ilf::projects::gltf
