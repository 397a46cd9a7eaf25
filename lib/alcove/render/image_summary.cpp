#include "alcove/base/detail/input_file.h"
#include "alcove/base/types.h"
#include "alcove/render/image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <png.h>

namespace alcove {

ImageSummary summarize_image(const std::filesystem::path& file) {
    check_input_file(file);
    ImageSummary summary;
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, file.c_str())) {
        summary = {"PNG", static_cast<int>(png.width), static_cast<int>(png.height), {}, {}};
        const char* const type = png.format & PNG_FORMAT_FLAG_LINEAR ? "16 bits" : "8 bits";
        if (png.format & PNG_FORMAT_FLAG_COLOR)
            summary.channels = {{"R", type}, {"G", type}, {"B", type}};
        else
            summary.channels = {{"Y", type}};
        if (png.format & PNG_FORMAT_FLAG_ALPHA)
            summary.channels.push_back({"A", type});
        png_image_free(&png);
        return summary;
    }
    try {
        const Imf::InputFile input(file.c_str());
        const Imf::Header& header = input.header();
        const Imath::Box2i& window = header.dataWindow();
        summary = {"EXR", window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}, {}};
        const char* const types[] = {"uint", "half", "float"};
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
            summary.channels.push_back({channel.name(), types[channel.channel().type]});
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
                summary.texts.emplace_back(attribute.name(), text->value());
    } catch (const std::exception&) {
        throw InputError(file.string() + ": is not a readable EXR or PNG image: write it again");
    }
    return summary;
}

}
