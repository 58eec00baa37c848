/*
 * OpenEXR's C++ library reads: unlike the C core of version 3.1 it knows DWAA and DWAB,
 * puts four half channels where it is told, and skips deep parts. Channels are asked for
 * by name. No exception leaves this file.
 */
#include "image/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputPart.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <vector>

namespace
{

/* A file in memory; what lies behind its end cannot be read. */
class memory_stream : public Imf::IStream
{
  public:
    memory_stream(const char *path, const uint8_t *bytes_, size_t size_,
                  bool (*is_wanted_)(void))
        : Imf::IStream(path), bytes(bytes_), size(size_), is_wanted(is_wanted_)
    {
    }

    bool read(char out[], int n) override
    {
        if (!is_wanted())
            throw std::runtime_error("cancelled");
        if (n < 0 || static_cast<size_t>(n) > size - at)
            throw std::runtime_error("it ends early");
        std::memcpy(out, bytes + at, static_cast<size_t>(n));
        at += static_cast<size_t>(n);
        return at < size;
    }

    uint64_t tellg() override
    {
        return at;
    }

    void seekg(uint64_t position) override
    {
        if (position > size)
            throw std::runtime_error("it ends early");
        at = static_cast<size_t>(position);
    }

  private:
    const uint8_t *bytes;
    size_t size, at = 0;
    bool (*is_wanted)(void);
};

/* A header's contents as the caller gets them; it holds what they point to. */
struct described {
    exr_description part = {};
    std::vector<const char *> channels;
    std::vector<exr_string> strings;

    explicit described(const Imf::Header &header)
    {
        const Imath::Box2i &window = header.dataWindow();
        part.width = int64_t(window.max.x) - window.min.x + 1;
        part.height = int64_t(window.max.y) - window.min.y + 1;
        bool dwa = header.compression() == Imf::DWAA_COMPRESSION ||
                   header.compression() == Imf::DWAB_COMPRESSION;
        part.best_ratio = dwa ? 65536 : 2048; /* runs of runs; deflate and Huffman runs */
        if (header.hasTileDescription()) {
            part.tile_width = header.tileDescription().xSize;
            part.tile_height = header.tileDescription().ySize;
        }
        describe_channels(header);
        describe_attributes(header);
    }

  private:
    void describe_channels(const Imf::Header &header)
    {
        const Imf::ChannelList &list = header.channels();
        for (auto c = list.begin(); c != list.end(); ++c) {
            const Imf::Channel &channel = c.channel();
            channels.push_back(c.name());
            part.bytes_per_pixel += channel.type == Imf::HALF ? 2 : 4;
            if (!part.subsampled && (channel.xSampling != 1 || channel.ySampling != 1))
                part.subsampled = c.name();
        }
        part.channels = channels.data();
        part.n_channels = channels.size();
    }

    /* "name" and "type" belong to the part, not to the picture. */
    void describe_attributes(const Imf::Header &header)
    {
        for (auto a = header.begin(); a != header.end(); ++a) {
            auto text = dynamic_cast<const Imf::StringAttribute *>(&a.attribute());
            if (text && std::strcmp(a.name(), "name") != 0 &&
                std::strcmp(a.name(), "type") != 0)
                strings.push_back({a.name(), text->value().c_str()});
        }
        part.strings = strings.data();
        part.n_strings = strings.size();
        part.has_chromaticities = Imf::hasChromaticities(header);
        if (part.has_chromaticities) {
            const Imf::Chromaticities &c = Imf::chromaticities(header);
            const Imath::V2f xy[] = {c.red, c.green, c.blue, c.white};
            std::memcpy(part.chromaticities, xy, sizeof part.chromaticities);
        }
    }
};

/* Every channel as float, where it stands in the caller's pixels. */
Imf::FrameBuffer aim(const exr_description &part, const Imf::Header &header,
                     float *pixels)
{
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < part.n_channels; c++)
        buffer.insert(part.channels[c],
                      Imf::Slice::Make(Imf::FLOAT, pixels + c, header.dataWindow(),
                                       part.n_channels * sizeof(float)));
    return buffer;
}

/* Tiles by themselves: as scanlines they would be gathered in rows of tiles before. */
void read_pixels(Imf::MultiPartInputFile &file, int n, const Imf::FrameBuffer &buffer)
{
    if (file.header(n).hasTileDescription()) {
        Imf::TiledInputPart part(file, n);
        part.setFrameBuffer(buffer);
        part.readTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
    } else {
        Imf::InputPart part(file, n);
        const Imath::Box2i &window = file.header(n).dataWindow();
        part.setFrameBuffer(buffer);
        part.readPixels(window.min.y, window.max.y);
    }
}

/* @return the number of the first flat part, -1 if there is none */
int flat_part(const Imf::MultiPartInputFile &file)
{
    for (int n = 0; n < file.parts(); n++)
        if (!file.header(n).hasType() || !Imf::isDeepData(file.header(n).type()))
            return n;
    return -1;
}

exr_result read_stream(memory_stream &stream, const exr_target *to)
{
    const int this_thread_only = 0;
    const bool reconstruct = false;
    Imf::MultiPartInputFile file(stream, this_thread_only, reconstruct);
    int n = flat_part(file);
    if (n < 0)
        return EXR_ONLY_DEEP;
    const Imf::Header &header = file.header(n);
    described what(header);
    float *pixels = to->place(&what.part, to->data);
    if (!pixels)
        return EXR_NOT_WANTED;
    read_pixels(file, n, aim(what.part, header, pixels));
    return EXR_READ;
}

} // namespace

exr_result exr_file_read(const char *path, const uint8_t *bytes, size_t size,
                         const exr_target *to, char message[300])
{
    try {
        memory_stream stream(path, bytes, size, to->is_wanted);
        return read_stream(stream, to);
    } catch (const std::bad_alloc &) {
        return EXR_NO_MEMORY;
    } catch (const std::exception &why) {
        std::strncpy(message, why.what(), 299);
        message[299] = '\0';
        return EXR_DAMAGED;
    }
}
