vs.1.1                          ; light and half vector in tangent space
; c0: world, c4: world, view and projection, c16: toward the light, c24: viewer
def c95, 0.5, 0.5, 0.5, 1.0

m4x4 oPos, v0, c4
m3x3 r1.xyz, v8, c0             ; tangent
m3x3 r2.xyz, v9, c0             ; binormal
m3x3 r3.xyz, v3, c0             ; normal

dp3 r4.x, r1, c16               ; direction to the light
dp3 r4.y, r2, c16
dp3 r4.z, r3, c16
mad oD0.xyz, r4.xyz, c95.x, c95.x

m4x4 r5, v0, c0                 ; position in world space
add r6.xyz, c24, -r5            ; toward the viewer, to unit length
dp3 r6.w, r6, r6
rsq r6.w, r6.w
mul r6.xyz, r6, r6.w
add r6.xyz, r6, c16             ; half-way to the light, to unit length
dp3 r6.w, r6, r6
rsq r6.w, r6.w
mul r6.xyz, r6, r6.w

dp3 r7.x, r1, r6
dp3 r7.y, r2, r6
dp3 r7.z, r3, r6
mad oD1.xyz, r7.xyz, c95.x, c95.x
mov oT0.xy, v7
