/// The words of docs/methods.md: what is wrong in the picture of each method, and why.
#pragma once

#include <map>
#include <string_view>

namespace alcove::docs {

inline constexpr std::string_view page_head = R"(# The methods

Written by `tools/docs.sh`; `alcove methods` prints the same facts. *ao* is visibility: 1 open, 0 buried; p is a point
of the surface, n its unit normal, d(x) = `map(x)`. Constants stand for the radius of the document that has them; any
other radius R is the same scene scaled by R₀/R, so that only the share of the scene that R covers matters.

Each row of pictures shows, from left to right, the scene of "SDF Ambient Occlusion — Detailed Reference" at the radius
of the method's own document, and two scans, baked at their vertices with a radius of 20 % of their diagonal and
default settings. Black is 0, white is 1. This is what exact rays say (of the documents' scene: at a radius of 1):

![exact rays](images/methods/reference.png)

)";

inline constexpr std::string_view table_head = R"(RMSE against cosine-weighted rays, 256 a pixel of the
documents' scene (sphere-traced, for it has no mesh) and 1,024 a vertex of the scans, with the bias and, after the semicolon, the standard deviation of the truth,
which is what the best constant guess would score:

| method | documents' scene | ChineseDragon-10kv | armadillo | `map()` calls a point |
| --- | --- | --- | --- | --- |
)";

inline const std::map<std::string_view, std::string_view> honest_words{
    {"classic", ""},
    {"exponential", ""},
    {"decay", ""},
    {"multiplicative", ""},
    {"multiscale", ""},
    {"jittered", ""},
    {"hemisphere", ""},
    {"hemisphere_random", ""},
    {"fibonacci", ""},
    {"traced", ""},
    {"exact", ""},
};

}
