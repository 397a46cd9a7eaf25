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
    {"classic", "The mouth of the lion and the neck of the armadillo are far too dark: a probe straight "
                "above a point is near a "
                "wall long before that wall hides much of the sky. Where the ground is open but for "
                "something at its side, as "
                "around the ring, it is right about where the shade lies and wrong about how fast it fades. "
                "Its bent normals, our own addition, lean the right way, but too little deep in corners."},
    {"exponential", "Nearly white: the weights halve from the first probe on, and the first probe, a fifth "
                    "of the radius up, is the "
                    "one that a wide valley does not reach. On the scene there is a rim where the shade of "
                    "the ring stops at once: "
                    "no probe of the fan sees further."},
    {"decay", "Black where the true answer is a third: the first probe weighs half of all, and between ball "
              "and ring it is on "
              "the surface. With `linear=true` it is softer, and as blind to the sides."},
    {"multiplicative", "The shape of the shade is good, its floor is not: six probes that each take a fifth "
                       "leave a quarter of the light "
                       "in the deepest corner, and a wide valley loses as much as a narrow one."},
    {"multiscale", "The flat grey between ball and ring is the floor of 0.035, reached as soon as one of the "
                   "seven products is 0. "
                   "Fine grain of the scan comes out strongly, for the lowest probes, 1/64 of the radius up, "
                   "read the roughness "
                   "of the grid as much as that of the scan."},
    {"jittered", "Too bright by half in every crease: each probe is divided by 1 + l. The six hashed heights "
                 "leave gaps, so that "
                 "the shade of the ring has steps."},
    {"hemisphere",
     "Open ground is grey, 0.92 instead of 1: probes that lie flat are nearer to the ground than they are "
     "long, and "
     "nothing tells that from a wall. On the ball the quadrants of the fixed directions show as facets; "
     "`surfel_frame=true` turns them with the surface."},
    {"hemisphere_random", "The factor 5 makes everything but the narrowest creases white and these black, a "
                          "drawing of lines rather than "
                          "of light. The facets on the ball are the directions fixed in world axes; another "
                          "seed gives other facets."},
    {"fibonacci", "The whole picture is grey, 0.62 to 0.73 in the open: the sum of 3 d over a plane is what "
                  "it is, and the "
                  "document's factor 6 does not make up for it. Contrast is small, for probes end at a tenth "
                  "of the scene's unit. "
                  "Divide by the open value for a mask."},
    {"traced", "What grain there is comes from 64 rays; more of them smooth it. The scans are a little too "
               "bright in folds "
               "finer than a voxel, which the grid has not, and rays start a tenth of a voxel off the "
               "surface. Looked at "
               "beside exact rays at the default radius of 10 %: bear and elephant differ by their grain "
               "alone; the grooves "
               "of the armadillo's shell, the lion's rims of eyes and mouth and the creases of the hand are "
               "lighter than "
               "they are; the camel has black spots between its knees and the cow a dark slot behind its "
               "tail, where the "
               "opposite surface is nearer than two voxels. Half the voxel halves all of that. ChineseDragon "
               "differs most, "
               "RMSE 0.06, and there exact rays are the odd ones: they start below a neighbouring face where "
               "the mesh folds "
               "over, and leave black specks."},
    {"calibrated",
     "Right on the average and wrong in particular: between ball and ring, a shape no training mesh had at "
     "that "
     "scale, it is black. It knows a crease by what creases were to the scans it was fitted to."},
    {"guided",
     "Three rays a vertex, and no grain: a model of the probes, fitted to the rays of the mesh itself, "
     "says what is usual, and neighbours whose field is alike share what it leaves. Single dark "
     "vertices, as in the mane of the lion, are drawn toward that until there are more rays."},
    {"exact",
     "Nothing but grain. The specks on the lion are true: vertices in folds that face a wall at once."},
};

}
