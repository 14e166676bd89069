#include "projects/gltf/compressed.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <cmath>

#include "projects/gltf/model.h"

namespace ilf::projects::gltf {

namespace {

std::size_t sizeAt(const tinygltf::Value& object, const std::string& member) {
    if (!object.Has(member)) return 0;
    const double value = object.Get(member).GetNumberAsDouble();
    return value > 0.0 ? static_cast<std::size_t>(value) : 0;
}

std::string textAt(const tinygltf::Value& object, const std::string& member) {
    return object.Has(member) && object.Get(member).IsString() ? object.Get(member).Get<std::string>() : "";
}

bool unpackedView(const tinygltf::Value& packed, const std::vector<unsigned char>& from,
                  std::vector<unsigned char>& into) {
    const std::size_t offset = sizeAt(packed, "byteOffset"), length = sizeAt(packed, "byteLength");
    const std::size_t count = sizeAt(packed, "count"), stride = sizeAt(packed, "byteStride");
    if (from.size() < offset + length) return false;
    into.resize(count * stride);
    const unsigned char* bytes = from.data() + offset;
    const std::string mode = textAt(packed, "mode"), filter = textAt(packed, "filter");
    int failed = -1;
    if (mode == "ATTRIBUTES")
        failed = meshopt_decodeVertexBuffer(into.data(), count, stride, bytes, length);
    else if (mode == "TRIANGLES")
        failed = meshopt_decodeIndexBuffer(into.data(), count, stride, bytes, length);
    else if (mode == "INDICES")
        failed = meshopt_decodeIndexSequence(into.data(), count, stride, bytes, length);
    if (failed != 0) return false;
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(into.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(into.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(into.data(), count, stride);
    return true;
}

/// One attribute for each vertex. Draco counts points; several may share a value.
std::optional<std::vector<float>> valuesOf(const draco::Mesh& mesh, std::uint32_t id,
                                           const tinygltf::Accessor& accessor) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    if (attribute == nullptr || attribute->num_components() != static_cast<int>(components)) return std::nullopt;
    const double whole = !accessor.normalized                                               ? 1.0
                         : accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE           ? 127.0
                         : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE  ? 255.0
                         : accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT          ? 32767.0
                         : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 65535.0
                                                                                            : 1.0;
    // Draco divides by the largest value itself where its attribute says that it is normalised.
    const double unit = attribute->normalized() ? 1.0 : whole;
    std::vector<float> values(std::size_t{mesh.num_points()} * components);
    for (std::uint32_t point = 0; point < mesh.num_points(); ++point) {
        float* to = values.data() + std::size_t{point} * components;
        const draco::AttributeValueIndex from = attribute->mapped_index(draco::PointIndex(point));
        if (from.value() >= attribute->size() ||
            !attribute->ConvertValue<float>(from, static_cast<std::int8_t>(components), to))
            return std::nullopt;
        for (std::size_t c = 0; c < components; ++c) {
            to[c] = static_cast<float>(to[c] / unit);
            if (!std::isfinite(to[c])) return std::nullopt;
        }
    }
    return values;
}

}  // namespace

void unpackMeshopt(tinygltf::Model& model, Findings& findings) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
        tinygltf::BufferView& view = model.bufferViews[i];
        const auto found = view.extensions.find("EXT_meshopt_compression");
        if (found == view.extensions.end()) continue;
        const tinygltf::Value& packed = found->second;
        const std::string where = "bufferViews[" + std::to_string(i) + "]";
        total += view.byteLength;
        std::vector<unsigned char> bytes;
        if (total > kMaxBytes) {
            findings.refuse(where, "unpacks to more than 1 GiB");
            return;
        }
        if (!unpackedView(packed, model.buffers[sizeAt(packed, "buffer")].data, bytes)) {
            findings.refuse(where, "is damaged: meshopt cannot unpack it");
            return;
        }
        view.buffer = static_cast<int>(model.buffers.size());
        view.byteOffset = 0;
        model.buffers.emplace_back().data = std::move(bytes);
    }
}

std::optional<Unpacked> unpackedDraco(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                      const std::string& where, Findings& findings) {
    const auto found = primitive.extensions.find("KHR_draco_mesh_compression");
    if (found == primitive.extensions.end()) return std::nullopt;
    const tinygltf::Value& packed = found->second;
    const auto refused = [&](const std::string& what) {
        findings.refuse(where, what);
        return std::nullopt;
    };
    const auto bytes = bytesOf(model, static_cast<int>(sizeAt(packed, "bufferView")));
    if (!bytes) return refused("has Draco data in a buffer whose bytes the file does not name");
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    draco::Decoder decoder;
    std::unique_ptr<draco::Mesh> mesh;
    try {
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) return refused("is damaged: Draco says \"" + decoded.status().error_msg_string() + "\"");
        mesh = std::move(decoded).value();
    } catch (const std::exception&) {  // memory: the data claim more than they can hold
        return refused("is damaged: Draco cannot unpack it");
    }
    if (!mesh || mesh->num_points() > kMaxVertices || mesh->num_faces() > kMaxTriangles)
        return refused("unpacks to more than is read");
    Unpacked unpacked{mesh->num_points(), {}, {}};
    unpacked.triangles.reserve(std::size_t{mesh->num_faces()} * 3);
    for (std::uint32_t i = 0; i < mesh->num_faces(); ++i) {
        for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(i)))
            unpacked.triangles.push_back(corner.value());
    }
    const tinygltf::Value& named = packed.Get("attributes");
    for (const std::string& name : named.Keys()) {
        const auto accessor = primitive.attributes.find(name);
        if (accessor == primitive.attributes.end()) continue;
        auto values = valuesOf(*mesh, static_cast<std::uint32_t>(sizeAt(named, name)),
                               model.accessors[static_cast<std::size_t>(accessor->second)]);
        if (!values) return refused("has Draco data without a sound " + name);
        unpacked.attributes[name] = std::move(*values);
    }
    return unpacked;
}

}  // namespace ilf::projects::gltf
