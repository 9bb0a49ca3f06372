vs.1.1                          ; the same with the half vector, and the highlight of the smooth surface
; c0: world, view and projection, c12: toward the light, of unit length, c14: viewer, c20: exponent, c24: how far
m4x4 oPos, v0, c0
add r2.xyz, c14.xyz, -v0.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mad r2.xyz, r2.xyz, r2.w, c12.xyz
dp3 r2.w, r2.xyz, r2.xyz
rsq r2.w, r2.w
mul r2.xyz, r2.xyz, r2.w
dp3 r6.x, v8, r2
dp3 r6.y, v9, r2
mul r1.xy, r6.xy, c24.xy
mov oT0.xy, v7.xy
add oT1.xy, v7.xy, r1.xy
dp3 r3.xy, v3, r2
mov r3.w, c20.x
lit r4, r3
mov oD0, r4.z
