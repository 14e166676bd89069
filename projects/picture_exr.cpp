#include "projects/picture_exr.h"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <cassert>
#include <cstdint>
#include <exception>
#include <vector>

#include "projects/exr_memory.h"

namespace ilf::projects {
namespace {

std::vector<const char*> channelsOf(int count) { return count == 3 ? std::vector{"R", "G", "B"} : std::vector{"Y"}; }

Imf::Header headerOf(const Radiance& values, const PictureFacts& facts, Imf::PixelType type) {
    Imf::Header header(values.width(), values.height());
    header.compression() = Imf::ZIP_COMPRESSION;
    if (values.channels() == 3) Imf::addChromaticities(header, Imf::Chromaticities());  // their default is Rec. 709
    for (const char* name : channelsOf(values.channels()))
        header.channels().insert(name, Imf::Channel(type));
    for (const auto& [key, value] : facts)
        header.insert(key, Imf::StringAttribute(value));
    return header;
}

/// The library reads, and never writes, what it is given here.
template <class T>
std::string written(const Imf::Header& header, Imf::PixelType type, const T* pixels, Size size, int channels) {
    const std::size_t column = sizeof(T) * static_cast<std::size_t>(channels);
    const std::size_t row = column * static_cast<std::size_t>(size.width);
    Imf::FrameBuffer frame;
    for (int c = 0; c < channels; ++c) {
        auto* base = reinterpret_cast<char*>(const_cast<T*>(pixels + c));
        frame.insert(channelsOf(channels)[static_cast<std::size_t>(c)], Imf::Slice(type, base, column, row));
    }
    ExrBytes stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(size.height);
    }
    return std::move(stream.bytes);
}

}  // namespace

Result<std::string> encodeExr(const Radiance& values, const PictureFacts& facts, ExrDepth depth) {
    assert(values.channels() == 1 || values.channels() == 3);
    try {
        if (depth == ExrDepth::single) {
            return written(headerOf(values, facts, Imf::FLOAT), Imf::FLOAT, values.pixels().data(), values.size(),
                           values.channels());
        }
        const std::vector<half> halves(values.pixels().begin(), values.pixels().end());
        return written(headerOf(values, facts, Imf::HALF), Imf::HALF, halves.data(), values.size(), values.channels());
    } catch (const std::exception& e) {
        return fail(Fault::cannotWrite, std::string("The picture could not be encoded as EXR: ") + e.what() + ".");
    }
}

}  // namespace ilf::projects
