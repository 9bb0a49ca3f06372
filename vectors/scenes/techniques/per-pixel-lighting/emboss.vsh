vs.1.1                          ; a second set of coordinates, moved toward the light, and the light of the smooth surface
; c0: world, view and projection, c12: toward the light, c20: 0, c24: how far
m4x4 oPos, v0, c0
dp3 r6.x, v8, c12
dp3 r6.y, v9, c12
mul r1.xy, r6.xy, c24.xy
mov oT0.xy, v7.xy
add oT1.xy, v7.xy, r1.xy
dp3 r2, v3, c12
max oD0, r2, c20
