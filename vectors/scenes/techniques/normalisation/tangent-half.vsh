vs.1.1                          ; the half vector in tangent space, as a colour and as coordinates
; c0: world, view and projection, c5: half vector, c20: one half
m4x4 oPos, v0, c0
dp3 r8.x, v8, c5
dp3 r8.y, v9, c5
dp3 r8.z, v3, c5
mad oD0.xyz, r8.xyz, c20.xyz, c20.xyz
mov oT0.xy, v7.xy
mov oT1.xyz, r8.xyz
mov oT2.xyz, r8.xyz
