vs.1.1                          ; the same, the binormal made here from normal and tangent
; c0: world, view and projection, c12: toward the light, c20: one half
m4x4 oPos, v0, c0
mov r3.xyz, v8.xyz
mul r0.xyz, v3.zxyw, r3.yzxw
mad r4.xyz, v3.yzxw, r3.zxyw, -r0.xyz
dp3 r6.x, v8, c12
dp3 r6.y, r4, c12
dp3 r6.z, v3, c12
mad oD0.xyz, r6.xyz, c20.xyz, c20.xyz
mov oT0.xy, v7.xy
