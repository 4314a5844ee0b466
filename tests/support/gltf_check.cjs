// Validates a .glb with the validator of glTF's own authors, found in NODE_PATH.
// usage: node gltf_check.cjs FILE; exit code 0 when there are neither errors nor warnings.
const fs = require('fs');
const validator = require('gltf-validator');

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then((report) => {
    const told = report.issues.messages.filter((message) => message.severity < 2);
    for (const message of told) console.log(`${message.code} ${message.pointer}: ${message.message}`);
    console.log(`glTF ${report.info.version}, ${report.info.totalTriangleCount} triangles, ` +
                `${report.info.animationCount} animations`);
    process.exit(told.length === 0 ? 0 : 1);
});
