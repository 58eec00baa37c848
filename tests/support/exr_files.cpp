#include "exr_files.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <vector>

namespace
{

const Imath::Box2i window({3, -5}, {EXR_WIDTH + 2, EXR_HEIGHT - 6});

Imf::PixelType type_of(const exr_kind *kind, int c)
{
    const Imf::PixelType turns[] = {Imf::HALF, Imf::FLOAT, Imf::UINT};
    switch (kind->values) {
    case EXR_UINT:
        return Imf::UINT;
    case EXR_HALF:
        return Imf::HALF;
    case EXR_FLOAT:
        return Imf::FLOAT;
    default:
        return turns[c % 3];
    }
}

/* Every channel's numbers in a plane of their own, in the file's type. */
class planes
{
  public:
    explicit planes(const exr_kind *of) : kind(of)
    {
        for (int c = 0; kind->channels[c]; c++) {
            values.emplace_back(size_t(EXR_WIDTH) * EXR_HEIGHT * size(c));
            for (int y = 0; y < EXR_HEIGHT; y++)
                for (int x = 0; x < EXR_WIDTH; x++)
                    put(c, x, y, exr_kind_value(kind, c, x, y));
        }
    }

    /* What smaller levels hold. */
    void fill(float value)
    {
        for (int c = 0; kind->channels[c]; c++)
            for (int y = 0; y < EXR_HEIGHT; y++)
                for (int x = 0; x < EXR_WIDTH; x++)
                    put(c, x, y, value);
    }

    Imf::FrameBuffer buffer()
    {
        Imf::FrameBuffer all;
        for (int c = 0; kind->channels[c]; c++)
            all.insert(kind->channels[c],
                       Imf::Slice::Make(type_of(kind, c), values[size_t(c)].data(),
                                        window, size(c)));
        return all;
    }

  private:
    size_t size(int c) const
    {
        return type_of(kind, c) == Imf::HALF ? sizeof(half) : sizeof(float);
    }

    void put(int c, int x, int y, float value)
    {
        char *to = &values[size_t(c)][size_t(y * EXR_WIDTH + x) * size(c)];
        if (type_of(kind, c) == Imf::HALF)
            *reinterpret_cast<half *>(to) = half(value);
        else if (type_of(kind, c) == Imf::FLOAT)
            *reinterpret_cast<float *>(to) = value;
        else
            *reinterpret_cast<uint32_t *>(to) = uint32_t(value);
    }

    const exr_kind *kind;
    std::vector<std::vector<char>> values;
};

Imf::Header header_of(const exr_kind *kind)
{
    bool upwards = kind->layout == EXR_SCANLINES_UPWARDS;
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window, 1, {0, 0}, 1,
                       upwards ? Imf::DECREASING_Y : Imf::INCREASING_Y,
                       Imf::Compression(kind->compression));
    for (int c = 0; kind->channels[c]; c++)
        header.channels().insert(kind->channels[c], Imf::Channel(type_of(kind, c)));
    return header;
}

void write_tiles(const exr_kind *kind, Imf::LevelMode mode, const char *path)
{
    planes pixels(kind);
    Imf::Header header = header_of(kind);
    header.setTileDescription({EXR_TILE_WIDTH, EXR_TILE_HEIGHT, mode});
    Imf::TiledOutputFile file(path, header, 0);
    for (int ly = 0; ly < file.numYLevels(); ly++)
        for (int lx = 0; lx < file.numXLevels(); lx++) {
            if (!file.isValidLevel(lx, ly))
                continue;
            if (lx + ly > 0)
                pixels.fill(99);
            file.setFrameBuffer(pixels.buffer());
            file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx, ly);
        }
}

void write_deep_part(Imf::MultiPartOutputFile &file)
{
    std::vector<unsigned> counts(size_t(EXR_WIDTH) * EXR_HEIGHT);
    std::vector<float *> depths(counts.size());
    Imf::DeepScanLineOutputPart part(file, 0);
    Imf::DeepFrameBuffer buffer;
    auto origin = window.min.x + window.min.y * EXR_WIDTH;
    buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char *>(counts.data() - origin),
                   sizeof(int), sizeof(int) * EXR_WIDTH));
    buffer.insert(
        "Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char *>(depths.data() - origin),
                            sizeof(float *), sizeof(float *) * EXR_WIDTH, sizeof(float)));
    part.setFrameBuffer(buffer);
    part.writePixels(EXR_HEIGHT);
}

void write_second_part(const exr_kind *kind, const char *path)
{
    planes pixels(kind);
    Imf::Header headers[] = {Imf::Header(Imath::Box2i({0, 0}, {99, 99}), window, 1,
                                         {0, 0}, 1, Imf::INCREASING_Y,
                                         Imf::ZIPS_COMPRESSION),
                             header_of(kind)};
    headers[0].setType(Imf::DEEPSCANLINE);
    headers[0].setName("deep");
    headers[0].setVersion(1);
    headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
    headers[1].setType(Imf::SCANLINEIMAGE);
    headers[1].setName("beauty");
    Imf::MultiPartOutputFile file(path, headers, 2, false, 0);
    write_deep_part(file);
    Imf::OutputPart part(file, 1);
    part.setFrameBuffer(pixels.buffer());
    part.writePixels(EXR_HEIGHT);
}

void write_scanlines(const exr_kind *kind, const char *path)
{
    planes pixels(kind);
    Imf::OutputFile file(path, header_of(kind), 0);
    file.setFrameBuffer(pixels.buffer());
    file.writePixels(EXR_HEIGHT);
}

} // namespace

/* Smooth, as what loses something expects; a channel is a quarter above that before it.
 */
float exr_kind_value(const exr_kind *kind, int c, int x, int y)
{
    int code = 64 * (c + 1) + x + y;
    return type_of(kind, c) == Imf::UINT ? float(code) : float(code) / 256.0f;
}

double exr_kind_tolerance(const exr_kind *kind, int c)
{
    Imf::PixelType type = type_of(kind, c);
    switch (kind->compression) {
    case Imf::PXR24_COMPRESSION:
        return type == Imf::FLOAT ? std::exp2(-15) : 0;
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
        return type == Imf::HALF ? 0.02 : 0;
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION:
        return type == Imf::UINT ? 0 : 0.02;
    default:
        return 0;
    }
}

void exr_kind_write(const exr_kind *kind, const char *path)
{
    switch (kind->layout) {
    case EXR_TILES:
        return write_tiles(kind, Imf::ONE_LEVEL, path);
    case EXR_TILES_MIPMAPPED:
        return write_tiles(kind, Imf::MIPMAP_LEVELS, path);
    case EXR_TILES_RIPMAPPED:
        return write_tiles(kind, Imf::RIPMAP_LEVELS, path);
    case EXR_SECOND_PART:
        return write_second_part(kind, path);
    default:
        return write_scanlines(kind, path);
    }
}
