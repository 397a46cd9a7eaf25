# Proves that layering.cmake and sizes.cmake bite: each case breaks one rule in a tiny made-up tree, and the
# script must fail and name the place. The tree as it is must pass.
#
#     cmake -D SCRATCH=<directory> -P rules_bite.cmake
cmake_minimum_required(VERSION 3.25)
set(tree ${SCRATCH}/tree)

function(make_sound_tree)
    file(REMOVE_RECURSE ${tree})
    file(WRITE ${tree}/lib/alcove/internal_headers.cmake "set(alcove_internal_headers grid/vdb.h)\n")
    file(WRITE ${tree}/lib/alcove/alcove.h
         "#include \"alcove/base/types.h\"\n#include \"alcove/field/detail/bricks.h\"\n#include \"alcove/field/field.h\"\n")
    file(WRITE ${tree}/lib/alcove/base/types.h "#include <glm/vec3.hpp>\n#include <vector>\n")
    file(WRITE ${tree}/lib/alcove/grid/detail/vdb_grid.h "#include <openvdb/openvdb.h>\n")
    file(WRITE ${tree}/lib/alcove/grid/band.cpp "#include \"alcove/grid/detail/vdb_grid.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/field.h "#include \"alcove/base/types.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/detail/bricks.h "#include \"alcove/field/field.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/bricks.cpp
         "#include \"alcove/field/detail/bricks.h\"\n#include \"alcove/grid/detail/vdb_grid.h\"\n")
    file(WRITE ${tree}/apps/alcove/main.cpp "#include \"common.h\"\n#include \"alcove/alcove.h\"\n")
endfunction()

# Runs a rule on the tree; `expected` is what it must say, empty where it must pass.
function(check rule expected)
    execute_process(COMMAND ${CMAKE_COMMAND} -D TREE=${tree} -P ${CMAKE_CURRENT_LIST_DIR}/${rule}.cmake
                    RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
    string(FIND "${said}" "${expected}" at)
    if(expected STREQUAL "" AND NOT status EQUAL 0)
        message(FATAL_ERROR "${rule} refuses a sound tree:\n${said}")
    elseif(NOT expected STREQUAL "" AND (status EQUAL 0 OR at EQUAL -1))
        message(FATAL_ERROR "${rule} does not say '${expected}' but:\n${said}")
    endif()
endfunction()

# Writes one file into a sound tree and expects the rule to name the place.
function(refused rule file content expected)
    make_sound_tree()
    file(WRITE ${tree}/${file} "${content}")
    check(${rule} "${expected}")
endfunction()

make_sound_tree()
check(layering "")
check(sizes "")

refused(layering lib/alcove/grid/band.cpp "\n#include <vector>\n  # include \"alcove/field/field.h\"\n"
        "lib/alcove/grid/band.cpp:3: \"alcove/field/field.h\" is a back-edge")
refused(layering lib/alcove/base/types.h "#include \"alcove/mesh/mesh.h\"\n" "lib/alcove/base/types.h:1")
refused(layering lib/alcove/field/trace.cpp "#include \"alcove/grid/grid_stack.h\"\n"
        "lib/alcove/field/trace.cpp:1: \"alcove/grid/grid_stack.h\" is a back-edge")
refused(layering lib/alcove/occlusion/bake.cpp "#include \"alcove/render/image.h\"\n" "is a back-edge")
refused(layering lib/alcove/mesh/read.cpp "#include \"alcove/alcove.h\"\n" "is for users")
refused(layering lib/alcove/mesh/read.cpp "#include \"../grid/plan.h\"\n" "is not written from alcove/ on")
refused(layering lib/alcove/shading/sun.cpp "#include <vector>\n" "is in a folder without a rule")
refused(layering lib/alcove/field/field.h "#include <openvdb/openvdb.h>\n" "lib/alcove/field/field.h:1")
refused(layering lib/alcove/field/field.h "#include <fmt/format.h>\n" "is third-party in a public header")
refused(layering lib/alcove/field/detail/bricks.h "#include \"alcove/grid/detail/vdb_grid.h\"\n" "is internal, and this header is public")
refused(layering lib/alcove/occlusion/bake.cpp "#include <embree3/rtcore.h>\n" "is embree")
refused(layering lib/alcove/grid/grid_io.cpp "#include <OpenEXR/ImfHeader.h>\n" "is openexr")
refused(layering apps/alcove/bake.cpp "#include \"alcove/grid/detail/vdb_grid.h\"\n" "apps/alcove/bake.cpp:1: \"alcove/grid/detail/vdb_grid.h\" brings openvdb")
refused(layering apps/alcove/bake.cpp "#include <tbb/parallel_for.h>\n" "is tbb")
refused(layering lib/alcove/field/combine.h "#include <tuple>\n" "leaves out field/combine.h")

make_sound_tree()
foreach(i RANGE 1 5)
    file(WRITE ${tree}/lib/alcove/grid/more_${i}.cpp "#include <openvdb/openvdb.h>\n")
endforeach()
check(layering "7 sources include OpenVDB")

string(REPEAT "//\n" 401 long_file)
refused(sizes lib/alcove/grid/band.cpp "${long_file}" "lib/alcove/grid/band.cpp: 401 lines")
string(REPEAT "//\n" 121 long_header)
make_sound_tree()
foreach(header types field/field field/bricks)
    file(WRITE ${tree}/lib/alcove/${header}.h "${long_header}")
endforeach()
check(sizes "the median header has 121 lines")
