" Vim syntax of the cag language. The names of functions and constants come from the program (tools/editors.sh).
if exists('b:current_syntax')
  finish
endif
let s:keep = &cpo
set cpo&vim

syn case match
syn iskeyword @,48-57,_,192-255
syn sync fromstart

" Words of any alphabet; a name before a `(` is called, one before a `=` at the start of a line is defined. The words that
" mean something of their own stand within names, so that what is named like them (a field, an argument) can be a name.
syn match cagName /[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*/ contains=@cagWords
syn match cagCall /[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*\ze(/ contains=@cagWords
syn match cagDefinition /\(^\|[;{]\)\s*\zs[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*\ze\s*=[=>]\@!/
syn match cagDefinition /^\s*\zs[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*\ze([^()]*\(([^()]*)[^()]*\)*)\s*=[=>]\@!/

syn match cagOperator /[-+*/%^=<>|&!]/
syn match cagOperator /[=!<>]=/
syn match cagPipe /|>/
syn match cagArrow /=>/
syn match cagRange /\.\.\(\.\|<\)\?/
syn match cagDelimiter /[][(){},;:]/

syn match cagNumber /\<\d[0-9_]*\(\.\d[0-9_]*\)\?\([eE][-+]\?\d[0-9_]*\)\?\(\a\)\@!/
syn match cagNumber /\<\d[0-9_]*\(\.\d[0-9_]*\)\?\([eE][-+]\?\d[0-9_]*\)\?\(deg\|rad\|turn\|mm\|cm\|um\|m\|in\|ft\)\>/ contains=cagUnit
syn match cagUnit /\(deg\|rad\|turn\|mm\|cm\|um\|m\|in\|ft\)\>/ contained

" The names of the program, by tools/editors.sh.
syn keyword cagConstant contained X Y Z deg frame frames identity inf origin pi rad tau time turn
syn keyword cagFunction contained abs acos acosh acting_points akima all along angle_between anticyclic antiderivative any approximate arc arc_through area area_light around arrow asin asinh at atan atan2 atanh attach attempt axes axis_angle axis_angle_of background basis basis_dependency basis_matrix basis_pieces basis_triangle bernstein bernstein_maxima best_model best_motion bezier bezier_join bezier_matrices bezier_surface bezier_triangle bilinear binormal blur boundary bounds box branches bspline bspline_surface calibrate camera camera_matrix canny carried cast catmull_rom cbrt ceil centroid chain_derivatives chamfer channel circle circle_tangent circle_through circles_tangent circular_vectors clamp clamp_ends clamped classify classify_knots clip closed_in closest closest_pose coefficients color color_of color_range colored_by compare_shapes complex_roots concat cone configuration conic conic_arc conic_by conic_point conic_points conic_segment conic_through constant_curve contact_at contain[s] continuity contour contours control_net convert_cubic convex_hull convolve coons coons_bicubic corners corners_of correlation_map cos cosh creases crop cross csv cubic_spline curvature curvature_class curvature_comb curvature_contours curvature_line curve curve_on cyclic cylinder cylindrical data_parameters degree dehomogenize denominator depth_image dequantize derivative determinant developable deviation dh dh_assign dh_table difference dilate distance distance_to_line distance_transform divide domain dot draft edges_of edit_corner eigen elevate ellipse ellipsoid elliptic_cone elliptic_cylinder end end_point ends enlarge enumerate erode error error_map euler euler_characteristic euler_of exact exp exploded extrema extrude faces faces_of fillet filter find_parts find_root find_template first first_form fit fit_affine fit_circle fit_cylinder fit_ellipse fit_formula fit_line fit_plane fit_projective fit_report fit_sphere fit_surface fit_surface_report fixed_link fk flat_spans flatten flip flipped floor follow fonts footprint formula frame_derivative frenet frenet_of gaussian_curvature get grid_parameters ground group half_space hedgehog height_field helix helix_motion hermite hermite_basis hermite_by_curvature hermite_matrix hermite_patch hermite_shape hermite_surface hidden histogram hlr hodograph homogeneous hough_lines hull hulls_disjoint hyperbola hyperbolic_cylinder hyperbolic_paraboloid hyperboloid hypot ik ik_all image implicit_at imprint in_degrees in_radians index_of inertia insert_knot integrate interference interior_point interlaced interpolate interpolate_surface intersect intersect_line intersect_lines intersection intrinsics inverse is_closed is_developable is_empty is_parallel is_planar is_singular is_straight is_watertight isocurve isolines isophotes jacobian jacobian_rank join join_curves join_surfaces joint_axes joint_path joint_values json keys knot_vector knots label label_regions least_squares len length lettering lettering_metrics light_image light_stripe line line_crossings line_image line_path line_style line_through link_frames linspace ln locate_by_bearings locate_by_ranges loft log10 log2 look_at look_up lower majority manipulability map map_onto mask_image match_edge match_error mate material max maximize mdh mean_curvature mean_rotation measure median meet_lines mesh mesh_check min minimize minkowski mirrored mix moment motion_of motor_values move_twist moved multiply named natural_curve near nearest net_mesh norm normal normal_curvature normal_image normals_of null_motion number_of numerator nurbs nurbs_arc nurbs_circle nurbs_surface offset on_plane orthonormal osculating_circle oslo otsu pairs parabola parabolic_blend parabolic_cylinder paraboloid parameter_at_length part_image partial parts_list patch_corners path_frame pchip perspective phantom_points pinhole pixel pixels plane plane_contact point_light points points_at polar polar_line polar_moment polygon polygonize polyline polynomial_curve polynomials pose_error posed position principal_curvatures prism prismatic product project project_point proximity quadric quadric_at quadric_center quadric_moved quadric_rows quadric_rulings quadric_tangent quantize quaternion quaternion_of random range_scan rasterize reachable read_csv read_iges read_image read_json read_mesh read_step read_text read_urdf recognize recognize_turned record rectangle reduce reduce_degree refine reflect reflect_line reflect_point region regular_polygon relation relaxed remap remove_knot repaired reparametrize repeat replace resize resized rest reverse revolute revolve roberts robot rod roots rotate rotation round rounded rounded_box rounded_cylinder rows rpy rpy_of ruled sample scale scan seam second_form section section_conic set_point sharpen shear shell sight_line sign signed_curvature silhouette simplify sin sinh skeleton sky slope smoothing_spline sobel solid solve solve_frame sort spans special_points sphere sphere_surface spherical split split_fields split_solid spot_light spread sqrt start start_point starts_with stereo straight_spans stretch stroke sum sun superellipsoid support surface sweep sweep_by tactile tan tangent tangent_line tangent_lines tangent_plane tanh tessellate text thicken threshold to_bezier to_nurbs tolerance torques torsion torus torus_surface trace transform transform_from translate translational transpose transpose_uv triad triad_derivative triangle_elevate triangle_point triangle_split trim tube turn_between turned twist_of type_of uniform_knots union unit unroll upper uv_image values values_of velocity vertices violations visible volume weave weights weld with_frames workspace zebra zip
syn cluster cagWords contains=cagConstant,cagFunction,cagConditional,cagRepeat,cagWordOperator,cagBoolean,cagStatement

syn keyword cagConditional if then else contained
syn keyword cagRepeat for contained
syn keyword cagWordOperator and or not in by contained
syn keyword cagBoolean true false none contained
syn keyword cagStatement show print assert contained
syn match cagParam /\<param\>\s\@=/ nextgroup=cagDefined skipwhite
syn match cagDefined /[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*/ contained
syn match cagImport /\<\(import\|as\)\>\s\@=/ nextgroup=cagModule skipwhite
syn match cagModule /[[:alpha:]_][[:alnum:]_.]*/ contained

" Behind a point and before a colon every word is an ordinary name.
syn match cagDot /\.\@1<!\.\.\@!/ nextgroup=cagMember skipwhite
syn match cagMember /[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*/ contained
syn match cagLabel /\([({,]\s*\|^\s*\)\@<=[[:alpha:]_\u0080-\U10ffff][[:alnum:]_\u0080-\U10ffff]*\ze\s*:/

syn region cagComment start=+//+ end=/$/ contains=cagTodo,@Spell oneline
syn region cagComment start=+/\*+ end=+\*/+ contains=cagComment,cagTodo,@Spell
syn region cagDocumentation start=+///+ end=/$/ contains=cagTodo,@Spell oneline
syn keyword cagTodo TODO FIXME XXX contained

" A text ends on its line; its { } hold expressions with texts of their own.
syn region cagText matchgroup=cagQuote start=/"/ end=/"/ end=/$/ contains=cagEscape,cagInterpolation,@Spell
syn match cagEscape /\\\(["\\nt{}]\|u{\x\{1,6}}\)/ contained
syn region cagInterpolation matchgroup=cagBrace start=/{/ end=/}/ contained contains=TOP,@Spell
syn region cagBraces matchgroup=cagDelimiter start=/{/ end=/}/ contained containedin=cagInterpolation,cagBraces contains=TOP
syn region cagRaw matchgroup=cagQuote start=/`/ end=/`/

hi def link cagName Normal
hi def link cagCall Function
hi def link cagDefinition Identifier
hi def link cagOperator Operator
hi def link cagPipe Operator
hi def link cagArrow Operator
hi def link cagRange Operator
hi def link cagDelimiter Delimiter
hi def link cagNumber Number
hi def link cagUnit Type
hi def link cagConstant Constant
hi def link cagFunction Function
hi def link cagConditional Conditional
hi def link cagRepeat Repeat
hi def link cagWordOperator Operator
hi def link cagBoolean Boolean
hi def link cagStatement Statement
hi def link cagParam StorageClass
hi def link cagImport Include
hi def link cagModule Identifier
hi def link cagDot Delimiter
hi def link cagDefined Identifier
hi def link cagMember Identifier
hi def link cagLabel Identifier
hi def link cagComment Comment
hi def link cagDocumentation SpecialComment
hi def link cagTodo Todo
hi def link cagText String
hi def link cagQuote String
hi def link cagEscape SpecialChar
hi def link cagBrace Special
hi def link cagRaw String

let b:current_syntax = 'cag'
let &cpo = s:keep
unlet s:keep
