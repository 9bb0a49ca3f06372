vs.1.1                          ; where a map of a highlight lies: along N.H of the smooth surface
; c0: world, view and projection, c12: toward the light, of unit length, c14: viewer, c20: 0
m4x4 oPos, v0, c0
add r2.xyz, c14.xyz, -v0.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mad r2.xyz, r2.xyz, r2.w, c12.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mul r2.xyz, r2.xyz, r2.w
mov oT0.xy, v7.xy
mov oT1.x, c20.x
dp3 oT1.y, v3, r2
