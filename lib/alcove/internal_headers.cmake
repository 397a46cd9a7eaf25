# Headers for this source tree alone: not installed, and no public header may include them.
# All other headers under lib/alcove are public.
set(alcove_internal_headers
    accuracy/chart.h
    atomic_file.h
    grid/band.h
    grid/level_set.h
    grid/nearest.h
    grid/pieces.h
    grid/pseudonormals.h
    grid/radix_sort.h
    grid/solidity.h
    grid/triangle_tree.h
    grid/vdb.h
    grid/winding.h
    mesh/byte_reader.h
    mesh/edge_table.h
    mesh/file_bytes.h
    mesh/formats.h
    mesh/obj_document.h
    mesh/ply_document.h
    mesh/ply_parse.h
    mesh/text_scanner.h
    mesh/weld.h
    occlusion/linear_model.h
    occlusion/neighbourhood.h
    occlusion/shared_rays.h
    render/camera_rays.h)
