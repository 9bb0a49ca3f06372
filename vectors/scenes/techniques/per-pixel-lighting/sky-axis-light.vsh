vs.1.1                          ; the axis of the sky and the direction to the light in tangent space, as colours
; c0: world, view and projection, c10: axis of the sky, c12: toward the light, c20: one half
m4x4 oPos, v0, c0
dp3 r5.x, v8, c10
dp3 r5.y, v9, c10
dp3 r5.z, v3, c10
mad oD0.xyz, r5.xyz, c20.xyz, c20.xyz
dp3 r6.x, v8, c12
dp3 r6.y, v9, c12
dp3 r6.z, v3, c12
mad oD1.xyz, r6.xyz, c20.xyz, c20.xyz
mov oT0.xy, v7.xy
