#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <vector>

#include "projects/exr_memory.h"
#include "projects/map_formats.h"
#include "projects/pictures.h"

namespace ilf::projects {
namespace {

const char* const kForth = "projector_of_camera";
const char* const kBack = "camera_of_projector";
const char* const kPlane = "projector_from_camera";
const std::string kFact = "fact:";  ///< before the keys of facts: the library's own attributes are texts as well

Imf::Header headerOf(const char* name, Size size, const char* mark, const DenseMap& map, const MapFacts& facts) {
    Imf::Header header(size.width, size.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* channel : {"X", "Y", mark})
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    const auto& m = map.nearest.m;
    const Imath::M33d plane(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    header.insert(kPlane, Imf::M33dAttribute(plane));
    for (const auto& [key, value] : facts)
        header.insert(kFact + key, Imf::StringAttribute(value));
    return header;
}

Imf::FrameBuffer bufferOf(float* points, float* marks, const char* mark, Size size) {
    const auto width = static_cast<std::size_t>(size.width);
    const auto slice = [](float* base, std::size_t column, std::size_t row) {
        return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), column * sizeof(float), row * sizeof(float));
    };
    Imf::FrameBuffer buffer;
    buffer.insert("X", slice(points, 2, 2 * width));
    buffer.insert("Y", slice(points + 1, 2, 2 * width));
    buffer.insert(mark, slice(marks, 1, width));
    return buffer;
}

void writePart(Imf::MultiPartOutputFile& file, int part, const Image<float>& points, const Image<std::uint8_t>& marks,
               const char* mark) {
    std::vector<float> numbers(marks.pixels().begin(), marks.pixels().end());
    Imf::OutputPart out(file, part);
    auto* xy = const_cast<float*>(points.pixels().data());  // the library reads, and never writes, what it saves
    out.setFrameBuffer(bufferOf(xy, numbers.data(), mark, points.size()));
    out.writePixels(points.height());
}

/// Throws what the library throws, or a runtime_error that ends a sentence.
void readPart(Imf::MultiPartInputFile& file, const char* name, const char* mark, Image<float>& points,
              Image<std::uint8_t>& marks) {
    int part = 0;
    while (part < file.parts() && !(file.header(part).hasName() && file.header(part).name() == name))
        ++part;
    if (part == file.parts()) throw std::runtime_error(std::string("it has no part \"") + name + "\"");
    const Imf::Header& header = file.header(part);
    for (const char* channel : {"X", "Y", mark}) {
        const Imf::Channel* found = header.channels().findChannel(channel);
        if (found == nullptr) throw std::runtime_error(std::string("it has no channel \"") + channel + "\"");
        if (found->xSampling != 1 || found->ySampling != 1) throw std::runtime_error("its channels are subsampled");
    }
    const Imath::Box2i window = header.dataWindow();
    const auto width = std::int64_t{window.max.x} - window.min.x + 1;
    const auto height = std::int64_t{window.max.y} - window.min.y + 1;
    if (window.min.x != 0 || window.min.y != 0) throw std::runtime_error("its window does not begin at 0, 0");
    if (width < 1 || height < 1 || width * height > kMaxPixels) throw std::runtime_error("its size makes no sense");
    const Size size{static_cast<int>(width), static_cast<int>(height)};
    std::vector<float> xy(static_cast<std::size_t>(width * height) * 2);
    std::vector<float> numbers(static_cast<std::size_t>(width * height));
    Imf::InputPart in(file, part);
    in.setFrameBuffer(bufferOf(xy.data(), numbers.data(), mark, size));
    in.readPixels(0, size.height - 1);
    std::vector<std::uint8_t> bytes(numbers.size());
    std::transform(numbers.begin(), numbers.end(), bytes.begin(), [&](float v) {
        if (!(v >= 0.0F && v <= 255.0F)) throw std::runtime_error(std::string(mark) + " is not within 0 to 255");
        return static_cast<std::uint8_t>(std::lround(v));
    });
    points = Image<float>(size, 2, std::move(xy));
    marks = Image<std::uint8_t>(size, 1, std::move(bytes));
}

}  // namespace

Result<std::string> mapAsExr(const DenseMap& map, const MapFacts& facts) {
    try {
        const std::vector<Imf::Header> headers{headerOf(kForth, map.camera(), "confidence", map, facts),
                                               headerOf(kBack, map.projector(), "seen", map, facts)};
        ExrBytes stream;
        {
            Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), true);
            writePart(file, 0, map.projectorOfCamera, map.confidence, "confidence");
            writePart(file, 1, map.cameraOfProjector, map.seen, "seen");
        }
        return std::move(stream.bytes);
    } catch (const std::exception& e) {
        return fail(Fault::cannotWrite, std::string("The map could not be written as EXR: ") + e.what() + ".");
    }
}

Result<MapFile> mapFromExr(std::string_view bytes, const std::string& name) {
    try {
        ExrReading stream(bytes, "map");
        Imf::MultiPartInputFile file(stream);
        MapFile result;
        DenseMap& map = result.map;
        readPart(file, kForth, "confidence", map.projectorOfCamera, map.confidence);
        readPart(file, kBack, "seen", map.cameraOfProjector, map.seen);
        const auto* plane = file.header(0).findTypedAttribute<Imf::M33dAttribute>(kPlane);
        if (plane == nullptr) throw std::runtime_error(std::string("it has no \"") + kPlane + "\"");
        for (int i = 0; i < 9; ++i)
            map.nearest.m[static_cast<std::size_t>(i)] = plane->value()[i / 3][i % 3];
        for (auto at = file.header(0).begin(); at != file.header(0).end(); ++at) {
            const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute());
            const std::string key = at.name();
            if (text != nullptr && key.starts_with(kFact)) result.facts[key.substr(kFact.size())] = text->value();
        }
        return result;
    } catch (const std::exception& e) {
        return fail(Fault::badFile, name + " cannot be read as a scanned map: " + e.what() + ".");
    }
}

}  // namespace ilf::projects
