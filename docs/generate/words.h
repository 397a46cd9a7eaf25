/// The prose of docs/methods.md: the introduction, and what is wrong in the image of each method, and why.
#pragma once

#include <map>
#include <string_view>

namespace alcove::docs {

inline constexpr std::string_view page_head = R"(# The methods

Written by `tools/docs.sh methods`; `alcove methods` prints the same facts. *ao* is visibility: 1 is open, 0 is fully
occluded. In the formulas, p is a point on the surface, n its unit normal, and d(x) = `map(x)`. The constants of a
formula are those of its reference document, at the radius R₀ of that document. At any other radius R, a method computes
what it would compute at R₀ on the scene scaled by R₀/R, so only the ratio of R to the size of the scene matters.

Each row of images shows three scenes. On the left is the reference scene of "SDF Ambient Occlusion — Detailed
Reference", at the radius of the method's own document. The other two are scans, ChineseDragon-10kv.off (a lion) and
armadillo.off, baked at their vertices with a radius of 20 % of their diagonal and default settings. Black is 0, white
is 1. These are the images by exact rays (by `traced` at a radius of 1 for the reference scene):

![exact rays](images/methods/reference.png)

)";

inline constexpr std::string_view table_head =
    R"(The table gives the RMSE against cosine-weighted rays: 256 per pixel of the reference scene (sphere-traced,
because it has no mesh) and 1,024 per vertex of the scans. In parentheses are the bias and, after the semicolon, the
standard deviation of the reference values, which is the RMSE of the best constant guess:

| method | reference scene | ChineseDragon-10kv | armadillo | cost |
| --- | --- | --- | --- | --- |
)";

inline const std::map<std::string_view, std::string_view> image_remarks{
    {"classic", "The lion's mouth and the armadillo's neck are far too dark: a probe straight above a point comes "
                "near a wall long before that wall hides much of the sky. On open ground with an occluder to one "
                "side, as around the ring, the shade is in the right place, but fades at the wrong rate. The bent "
                "normals, which are our own addition, lean the right way, but not far enough deep in corners."},
    {"exponential", "Nearly white: the weights halve from the first probe on, and the first probe, a fifth of the "
                    "radius up, is the one that a wide valley does not occlude. In the reference scene, the shade "
                    "of the ring ends at a sharp edge, because no probe sees further."},
    {"decay", "Black where the correct value is a third: the first probe has half of the total weight, and between "
              "ball and ring it is on the surface. `linear=true` is softer, but just as blind to the sides."},
    {"multiplicative", "The shape of the shade is good, but its minimum is not: six probes that each take a fifth "
                       "leave a quarter of the light in the deepest corner, and a wide valley loses as much light "
                       "as a narrow one."},
    {"multiscale", "The flat grey between ball and ring is the `floor` of 0.035, which the result reaches as soon as "
                   "one of the seven factors is 0. The fine grain of the scan stands out, because the lowest probes, "
                   "1/64 of the radius up, measure the roughness of the grid as much as that of the scan."},
    {"jittered",
     "Far too bright in every crease, because each probe is divided by 1 + l: a closed crevice keeps almost "
     "half of its light. The six hashed heights leave gaps, so the shade of the ring has steps."},
    {"hemisphere", "Open ground is grey, 0.92 instead of 1: the end of a nearly horizontal probe is nearer to the "
                   "ground than the probe is long, and the formula cannot distinguish that from a wall. On the "
                   "ball, the quadrants of the fixed directions show as facets; with `surfel_frame=true` they turn "
                   "with the surface."},
    {"hemisphere_random", "The factor 5 makes everything white except the narrowest creases, which it makes black: "
                          "a line drawing rather than shading. The facets on the ball come from directions that are "
                          "fixed in world axes; another seed gives other facets."},
    {"fibonacci", "The whole image is grey, 0.62 to 0.73 in the open: above a plane, the sum of 3 d is too small, and "
                  "the factor 6 of the formula does not make up for it. The contrast is low, because probes end at a "
                  "tenth of the scene's unit. To get a mask, divide by the value on open ground."},
    {"traced", "The remaining grain comes from 64 rays; more rays smooth it. The scans are a little too bright in "
               "folds finer than a voxel, because the grid does not contain them and rays start a tenth of a voxel "
               "off the surface. Compared with exact rays at the default radius of 10 %: bear.off and elephant.off "
               "differ only in their grain; the grooves in the shell of armadillo.off, the rims of the eyes and the "
               "mouth of lion.off and the creases of hand.off are too light; camel.off has black spots between its "
               "knees and cow.off a dark slot behind its tail, where the opposite surface is nearer than two voxels. "
               "Halving the voxel halves all of these errors. ChineseDragon-10kv.off differs most, with an RMSE of "
               "0.06. There the exact rays are at fault: where the mesh folds over, they start below a neighbouring "
               "face and leave black specks."},
    {"calibrated", "The network is used as trained, without a fit to these scenes. It is right on average and wrong in "
                   "places: between ball and ring, it shows faint stripes."},
    {"guided", "Three rays per vertex, and no grain: a regression on the probes, fitted to the rays of the mesh "
               "itself, predicts the value, and vertices with similar probes share the residuals. Single dark "
               "vertices, as in the lion's mane, are pulled toward that prediction until there are more rays."},
    {"exact", "Nothing but grain. The specks on the lion are correct: they are vertices in folds, right in front of a "
              "wall."},
};

}
